#include "tenon/mpc/closed_loop.hpp"

#include <stdexcept>
#include <utility>

namespace tenon {

namespace {

constexpr double kRounding = 1e-9;  // of times, in periods

void check(const std::string& what, int controller, int plant) {
  if (controller == plant) return;
  throw std::invalid_argument("the controller has " + std::to_string(controller) + " " + what + " (expected " + std::to_string(plant) +
                              ", as the plant)");
}

}  // namespace

ClosedLoop::ClosedLoop(Plant& plant, Controller& controller, double duration)
    : plant_(plant),
      controller_(controller),
      duration_(duration),
      measurements_(plant.num_measurements()),
      commands_(plant.num_commands()),
      row_(1 + plant.num_outputs() + plant.num_measurements() + plant.num_commands() + controller.num_outputs()) {
  check("measurements", controller.num_measurements(), plant.num_measurements());
  check("commands", controller.num_commands(), plant.num_commands());
}

std::vector<std::string> ClosedLoop::columns() const {
  std::vector<std::string> names{"t"};
  for (int i = 0; i < plant_.num_outputs(); ++i) names.push_back(plant_.output_name(i));
  for (int i = 0; i < plant_.num_measurements(); ++i) names.push_back(plant_.measurement_name(i));
  for (int i = 0; i < plant_.num_commands(); ++i) names.push_back(plant_.command_name(i));
  for (int i = 0; i < controller_.num_outputs(); ++i) names.push_back(controller_.output_name(i));
  return names;
}

void ClosedLoop::run(std::uint64_t seed, const std::function<bool(const Vector& row)>& on_tick) {
  plant_.reset(seed);
  controller_.reset();
  const double period = controller_.period();
  for (long k = 0; static_cast<double>(k) * period < duration_ - kRounding * period && !plant_.finished(); ++k) {
    const double t = static_cast<double>(k) * period;
    plant_.measure(measurements_);
    controller_.update(t, measurements_, commands_);
    if (on_tick) {
      fill_row(t);
      if (!on_tick(row_)) return;
    }
    plant_.advance(static_cast<double>(k + 1) * period, commands_);
  }
}

void ClosedLoop::fill_row(double t) {
  Eigen::Index next = 0;
  const auto part = [&](Eigen::Index size) { return row_.segment(std::exchange(next, next + size), size); };
  part(1)[0] = t;
  plant_.outputs(part(plant_.num_outputs()));
  part(measurements_.size()) = measurements_;
  part(commands_.size()) = commands_;
  controller_.outputs(part(controller_.num_outputs()));
}

ClosedLoopExperiment::ClosedLoopExperiment(std::unique_ptr<Plant> plant, std::unique_ptr<Controller> controller, double duration)
    : plant_(std::move(plant)), controller_(std::move(controller)), loop_(*plant_, *controller_, duration) {}

std::vector<std::string> ClosedLoopExperiment::names() const {
  std::vector<std::string> names;
  for (int i = 0; i < plant_->num_verdicts(); ++i) names.push_back(plant_->verdict_name(i));
  names.insert(names.end(), {"steps", "iterations", "fallbacks"});
  return names;
}

void ClosedLoopExperiment::run(std::uint64_t seed, VectorRef row) {
  long steps = 0, iterations = 0, fallbacks = 0;
  loop_.run(seed, [&](const Vector&) {
    const StepLog step = controller_->last_step();
    ++steps;
    iterations += step.iterations;
    fallbacks += step.fell_back() ? 1 : 0;
    return true;
  });
  const int verdicts = plant_->num_verdicts();
  plant_->verdicts(row.head(verdicts));
  row.tail(3) << static_cast<double>(steps), static_cast<double>(iterations), static_cast<double>(fallbacks);
}

}  // namespace tenon
