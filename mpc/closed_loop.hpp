// A controller and the plant it is tried on, on their clocks: the controller's commands are held for a period.
//
//     measure, update, record, advance        until the plant has finished or the time is up
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tenon/core/controller.hpp"
#include "tenon/core/experiment.hpp"
#include "tenon/core/plant.hpp"

namespace tenon {

class ClosedLoop {
 public:
  /// Both must outlive it. Throws std::invalid_argument where one does not give what the other takes.
  ClosedLoop(Plant& plant, Controller& controller, double duration);

  /// Of a row: t, the truth, what is measured, what is commanded, what the controller says.
  std::vector<std::string> columns() const;

  /// One run in the world of this seed, from t = 0; `on_tick` sees each row and returns false to stop there. Allocates nothing itself.
  void run(std::uint64_t seed, const std::function<bool(const Vector& row)>& on_tick = nullptr);

 private:
  void fill_row(double t);

  Plant& plant_;
  Controller& controller_;
  double duration_;
  Vector measurements_, commands_, row_;
};

/// A closed loop as a sweep repeats it: the plant's verdicts, then steps, iterations and fallbacks of the controller.
class ClosedLoopExperiment final : public Experiment {
 public:
  ClosedLoopExperiment(std::unique_ptr<Plant> plant, std::unique_ptr<Controller> controller, double duration);

  std::vector<std::string> names() const override;
  std::string severity() const override { return plant_->severity(); }
  void run(std::uint64_t seed, VectorRef row) override;

 private:
  std::unique_ptr<Plant> plant_;
  std::unique_ptr<Controller> controller_;
  ClosedLoop loop_;
};

}  // namespace tenon
