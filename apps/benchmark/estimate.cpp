// estimate/...: updates of a scene's moving horizon estimator (slide, solve, covariance) along an experiment's records; Ipopt as a peer.
#include <fmt/format.h>

#include <algorithm>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/moving_horizon.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr std::uint64_t kWorlds = 3;

void run_estimator(const std::string& scene, const std::string& solver, std::uint64_t worlds, BenchmarkRun& out) {
  ControlTask task = make_task(scene);
  MovingHorizon estimator(std::move(*task.estimation),
                          [&](const Nlp& problem, const Options& options) { return make_solver(solver, problem, options); });
  const auto script = take_controller(task, task.baselines.front().name, nullptr);
  ClosedLoop loop(*task.plant, *script, task.duration);
  const int outputs = task.plant->num_outputs(), measured = task.plant->num_measurements(), commanded = task.plant->num_commands();
  long iterations = 0;
  for (std::uint64_t world = 1; world <= worlds; ++world) {
    Vector held = Vector::Zero(commanded), y(measured);
    estimator.reset();
    loop.run(world, [&](const Vector& row) {
      y = row.segment(1 + outputs, measured);
      time_each(1, out, [&](int) { estimator.update(row[0], y, held); });
      held = row.segment(1 + outputs + measured, commanded);
      iterations += estimator.result().iterations;
      return true;
    });
  }
  out.notes.push_back(fmt::format("{:.2f} iterations an update, {} instants of {} states",
                                  static_cast<double>(iterations) / static_cast<double>(out.seconds.size()),
                                  estimator.window().intervals() + 1, estimator.num_estimates()));
}

}  // namespace

void add_estimate(std::vector<Benchmark>& rows) {
  const std::vector<SolverDescription> solvers = list_solvers();
  const bool has_peer = std::ranges::any_of(solvers, [](const auto& s) { return s.name == "ipopt" && s.available; });
  for (const std::string scene : {"pushed-block", "delta-payload"}) {
    rows.push_back({"estimate/" + scene, [=](BenchmarkRun& out) { run_estimator(scene, "newton-kkt", kWorlds, out); }});
    if (has_peer) rows.push_back({"estimate/" + scene + "/ipopt", [=](BenchmarkRun& out) { run_estimator(scene, "ipopt", 1, out); }});
  }
}

}  // namespace tenon
