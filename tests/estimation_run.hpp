// An experiment of a task whose commands are a script, and what its estimator makes of it, in one world after another.
//
// Prior and errors of what is positive count by their logarithms.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"

namespace tenon {

class EstimationRun {
 public:
  EstimationRun(const std::string& scene, const std::vector<std::string>& overrides)
      : task_(make_task(scene, overrides)),
        estimator_(
            take_estimator(task_, [](const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); })),
        script_(take_controller(task_, "script", nullptr)),
        loop_(*task_.plant, *script_, task_.duration) {}

  /// The estimator sees measurements and commands alone.
  void run(std::uint64_t seed) {
    const int outputs = task_.plant->num_outputs(), measured = task_.plant->num_measurements(), commanded = task_.plant->num_commands();
    Vector y(measured), held = Vector::Zero(commanded);
    estimator_->reset();
    mean.resize(estimator_->num_estimates());
    covariance.resize(mean.size(), mean.size());
    loop_.run(seed, [&](const Vector& row) {
      y = row.segment(1 + outputs, measured);
      const AllocationCounter counter;
      estimator_->update(row[0], y, held);
      allocations += counter.count();
      held = row.segment(1 + outputs + measured, commanded);
      truth = row.segment(1, mean.size());
      return true;
    });
    estimator_->mean(mean);
    estimator_->covariance(covariance);
  }

  Vector truth, mean;  // at the last measurement; the plant's first outputs are what is estimated
  Eigen::MatrixXd covariance;
  long allocations = 0;

  double deviation(int i) const { return std::sqrt(covariance(i, i)); }
  double correlation(int i, int j) const { return covariance(std::max(i, j), std::min(i, j)) / (deviation(i) * deviation(j)); }

  /// e' P^-1 e: chi squared where the estimator says the truth about its errors.
  double normalised_error() const {
    Vector e = truth - mean;
    for (int i = 0; i < e.size(); ++i) {
      if (estimator_->is_known_in_proportion(i)) e[i] = mean[i] * std::log(truth[i] / mean[i]);
    }
    const Eigen::MatrixXd whole = covariance.selfadjointView<Eigen::Lower>();
    return e.dot(whole.llt().solve(e));
  }

 private:
  ControlTask task_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<Controller> script_;
  ClosedLoop loop_;
};

/// Three deviations of the mean of chi squared with so many degrees of freedom, over so many worlds.
inline double consistency_bound(int freedom, int worlds) {
  return 3 * std::sqrt(2.0 * freedom / worlds);
}

}  // namespace tenon
