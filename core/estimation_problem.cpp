#include "tenon/core/estimation_problem.hpp"

#include <stdexcept>
#include <utility>

namespace tenon {

EstimationProblem::EstimationProblem(std::shared_ptr<const Dae> dae_, std::shared_ptr<const SmoothFunction> measured_)
    : dae(std::move(dae_)),
      measured(std::move(measured_)),
      noise(Vector::Zero(measured->num_values())),
      mean(Vector::Zero(dae->num_states())),
      deviation(mean),
      is_positive(static_cast<std::size_t>(mean.size()), false),
      ripple(Vector::Zero(dae->num_inputs())),
      drift(mean) {
  solve.warm_start = true;
  solve.scaling = false;
}

void validate(const EstimationProblem& problem) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(problem.name + ": " + what);
  };
  const auto sized = [&](const Vector& values, int size, const std::string& what) {
    require(values.size() == size && values.allFinite(),
            what + " has " + std::to_string(values.size()) + " entries (expected " + std::to_string(size) + " finite ones)");
  };
  const int nx = problem.dae->num_states(), nz = nx + problem.dae->num_inputs(), arguments = problem.measured->num_arguments();
  require(problem.dae->num_algebraics() == 0 && problem.dae->has_derivatives(),
          "a Dae that is not solved for its derivatives (expected xdot = f(x, u), without algebraic variables)");
  require(arguments == nz,
          "what is measured takes " + std::to_string(arguments) + " arguments (expected " + std::to_string(nz) + ", x and u)");
  sized(problem.ripple, nz - nx, "ripple");
  sized(problem.noise, problem.measured->num_values(), "noise");
  sized(problem.mean, nx, "mean"), sized(problem.deviation, nx, "deviation"), sized(problem.drift, nx, "drift");
  require(static_cast<int>(problem.is_positive.size()) == nx,
          "what is positive has the wrong length (expected " + std::to_string(nx) + ")");
  for (int i = 0; i < nx; ++i) {
    require(!problem.is_positive[static_cast<std::size_t>(i)] || problem.mean[i] > 0, "the mean of " + problem.dae->state_name(i) + " is " +
                                                                                          std::to_string(problem.mean[i]) +
                                                                                          " (expected more than 0, as it is positive)");
  }
  require((problem.noise.array() > 0).all(), "a noise that is not positive (expected more than 0)");
  require((problem.deviation.array() > 0).all(), "a deviation that is not positive (expected more than 0)");
  require((problem.ripple.array() >= 0).all(), "a negative ripple (expected 0 or more)");
  require((problem.drift.array() >= 0).all(), "a negative drift (expected 0 or more)");
  require(problem.window >= 1, "a window of " + std::to_string(problem.window) + " intervals (expected at least 1)");
  require(problem.longest_step > 0, "a longest step of " + std::to_string(problem.longest_step) + " s (expected more than 0)");
}

}  // namespace tenon
