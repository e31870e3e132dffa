#include "tenon/core/quasi_newton_nlp.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace tenon {

QuasiNewtonNlp::QuasiNewtonNlp(const Nlp& problem) : NlpDecorator(problem) {
  if (problem.num_variables() > kMostVariables) {
    throw std::invalid_argument(problem.name() + " gives no Hessian and has " + std::to_string(problem.num_variables()) +
                                " variables (expected at most " + std::to_string(kMostVariables) + ", or a Hessian)");
  }
}

Nlp::Workspace QuasiNewtonNlp::make_workspace() const {
  const int n = num_variables();
  auto made = std::make_unique<Memory>();
  made->problem = problem_.make_workspace();
  for (Linearisation* side : {&made->here, &made->last}) {
    side->x_of_gradient = side->x_of_jacobian = Vector::Constant(n, std::numeric_limits<double>::quiet_NaN());
    side->gradient.setZero(n);
    side->jacobian = problem_.jacobian_pattern().zero_matrix();
  }
  made->epoch = epoch_;
  made->B.setIdentity(n, n);
  made->s.setZero(n);
  made->y.setZero(n);
  made->Bs.setZero(n);
  return made;
}

void QuasiNewtonNlp::gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const {
  Memory& at = memory(workspace);
  problem_.gradient(x, at.problem, at.here.gradient);
  at.here.x_of_gradient = x;
  gradient = at.here.gradient;
}

void QuasiNewtonNlp::jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const {
  Memory& at = memory(workspace);
  problem_.jacobian(x, at.problem, values_of(at.here.jacobian));
  at.here.x_of_jacobian = x;
  std::ranges::copy(values_of(at.here.jacobian), values.begin());
}

void QuasiNewtonNlp::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  Memory& at = memory(workspace);
  if (at.epoch != epoch_) {
    at.epoch = epoch_;
    at.has_last = at.has_curvature = false;
    at.B.setIdentity();
  }
  if (at.here.x_of_gradient != x) {
    problem_.gradient(x, at.problem, at.here.gradient);
    at.here.x_of_gradient = x;
  }
  if (at.here.x_of_jacobian != x) {
    problem_.jacobian(x, at.problem, values_of(at.here.jacobian));
    at.here.x_of_jacobian = x;
  }
  if (at.has_last) {
    at.s = x - at.last.x_of_gradient;
    at.y = sigma * (at.here.gradient - at.last.gradient);
    at.y.noalias() += at.here.jacobian.transpose() * lambda;
    at.y.noalias() -= at.last.jacobian.transpose() * lambda;
    update(at);
  }
  at.last.x_of_gradient = x;
  at.last.gradient = at.here.gradient;
  std::ranges::copy(values_of(at.here.jacobian), at.last.jacobian.valuePtr());
  at.has_last = true;

  std::size_t k = 0;
  for (int j = 0; j < num_variables(); ++j) {
    for (int i = j; i < num_variables(); ++i) values[k++] = at.B(i, j);
  }
}

// (1)
void QuasiNewtonNlp::update(Memory& at) {
  if (!at.s.allFinite() || !at.y.allFinite() || at.s.squaredNorm() == 0) return;
  double sy = at.s.dot(at.y);
  if (!at.has_curvature) {
    if (sy > 0) at.B.setIdentity(), at.B *= at.y.squaredNorm() / sy;
    at.has_curvature = true;
  }
  at.Bs.noalias() = at.B.selfadjointView<Eigen::Lower>() * at.s;
  const double sBs = at.s.dot(at.Bs);
  if (sy < 0.2 * sBs) {
    const double theta = 0.8 * sBs / (sBs - sy);
    at.y = theta * at.y + (1 - theta) * at.Bs;
    sy = at.s.dot(at.y);
  }
  at.B.selfadjointView<Eigen::Lower>().rankUpdate(at.Bs, -1 / sBs);
  at.B.selfadjointView<Eigen::Lower>().rankUpdate(at.y, 1 / sy);
}

}  // namespace tenon
