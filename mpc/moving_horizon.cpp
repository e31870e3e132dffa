#include "tenon/mpc/moving_horizon.hpp"

#include <algorithm>
#include <utility>

namespace tenon {

namespace {

EstimationProblem validated(EstimationProblem problem) {
  validate(problem);
  return problem;
}

}  // namespace

MovingHorizon::MovingHorizon(EstimationProblem problem, const SolverFactory& make_solver)
    : problem_(validated(std::move(problem))),
      window_(problem_),
      solver_(make_solver(window_, problem_.solve)),
      point_(window_.num_variables(), window_.num_constraints()),
      mean_(problem_.mean),
      slope_(problem_.mean),
      covariance_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())) {
  reset();
}

MovingHorizon::~MovingHorizon() = default;

void MovingHorizon::reset() {
  window_.reset();
  start_afresh();
  mean_ = problem_.mean;
  covariance_ = problem_.deviation.cwiseAbs2().asDiagonal();
  has_started_ = false;
  result_ = {};
}

void MovingHorizon::start_afresh() {
  window_.start(point_.x);
  point_.lambda.setZero();
}

void MovingHorizon::update(double t, ConstVectorRef measurements, ConstVectorRef commands) {
  window_.slide(point_.x, has_started_ ? std::max(0.0, t - last_) : 0, commands, measurements);
  window_.shift(point_.x, point_.lambda);
  last_ = t;
  has_started_ = true;
  result_ = solver_->solve(point_);
  if (!point_.x.allFinite()) start_afresh();

  const GaussianBelief& belief = window_.belief(point_.x);
  window_.to_state(point_.x.tail(mean_.size()), mean_, slope_);
  for (Eigen::Index c = 0; c < mean_.size(); ++c) covariance_.col(c) = slope_[c] * slope_.cwiseProduct(belief.covariance.col(c));
}

}  // namespace tenon
