// Closed loops of the pole between soft walls: by the receding horizon, and by exhaustive search.
#pragma once

#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/soft_walls_reference.hpp"

namespace tenon::soft_walls {

/// Exhaustive search as a controller.
class ReferenceController final : public Controller {
 public:
  explicit ReferenceController(int intervals) : search_(Model(), Weights(), intervals) {}

  int num_measurements() const override { return 4; }
  int num_commands() const override { return 1; }
  double period() const override { return Parameters().step; }
  void reset() override {}
  void update(double, ConstVectorRef measurements, VectorRef commands) override { commands[0] = search_.command(State(measurements)); }

 private:
  ExhaustiveSearch search_;
};

struct Outcome {
  bool arrived = false;
  double cost = 0;
};

/// The task's own controller, or another in its place.
inline Outcome run_in_world(std::uint64_t seed, int intervals, std::unique_ptr<Controller> controller = nullptr) {
  ControlTask task = make_task("cart-pole-soft-walls", {"intervals=" + std::to_string(intervals)});
  if (!controller) {
    controller = take_controller(task, "mpc", [](const Nlp& problem, const Options& options) {
      return make_solver("newton-kkt", problem, options);
    });
  }
  ClosedLoop(*task.plant, *controller, task.duration).run(seed);
  Vector verdicts(task.plant->num_verdicts());
  task.plant->verdicts(verdicts);
  return {verdicts[4] == 1, verdicts[6]};
}

inline Outcome reference_in_world(std::uint64_t seed, int intervals) {
  return run_in_world(seed, intervals, std::make_unique<ReferenceController>(intervals));
}

}  // namespace tenon::soft_walls
