// A moving horizon estimator: the last N intervals of an estimation problem, solved anew at every measurement; what is older is a prior.
//
//     slide the window (the oldest instant becomes part of the prior)  ->  solve  ->  x_N, and how sure that is
//
// In a linear problem it is Kalman's filter, whatever N; in one that is not, the window is what is still open to another explanation.
// Equations: moving_horizon.md.
#pragma once

#include <memory>

#include "tenon/core/estimator.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/solver_factory.hpp"
#include "tenon/mpc/estimation_window.hpp"

namespace tenon {

class MovingHorizon final : public Estimator {
 public:
  /// Throws std::invalid_argument where the problem makes no sense, and what the factory throws.
  MovingHorizon(EstimationProblem problem, const SolverFactory& make_solver);
  ~MovingHorizon() override;

  int num_measurements() const override { return problem_.measured->num_values(); }
  int num_estimates() const override { return problem_.dae->num_states(); }
  void reset() override;
  void update(double t, ConstVectorRef measurements, ConstVectorRef commands) override;
  void mean(VectorRef values) const override { values = mean_; }
  void covariance(MatrixRef values) const override { values = covariance_; }
  bool is_known_in_proportion(int i) const override { return problem_.is_positive[static_cast<std::size_t>(i)]; }
  std::string estimate_name(int i) const override { return "believed_" + problem_.dae->state_name(i); }

  /// How the last window was solved, and the window itself with its solution.
  const Result& result() const { return result_; }
  EstimationWindow& window() { return window_; }
  const Point& solution() const { return point_; }

 private:
  void start_afresh();

  const EstimationProblem problem_;
  EstimationWindow window_;
  std::unique_ptr<Solver> solver_;
  Point point_;
  Vector mean_, slope_;
  Eigen::MatrixXd covariance_;
  double last_ = 0;
  bool has_started_ = false;
  Result result_;
};

}  // namespace tenon
