// The window as a nonlinear program: its stages, patterns, functions and names.
#include <algorithm>
#include <utility>

#include "tenon/mpc/estimation_window.hpp"

namespace tenon {

Stages EstimationWindow::stages() const {
  Stages stages;
  for (int k = 0; k <= intervals_; ++k) {
    const bool last = k == intervals_;
    const IndexRange variables{state_at(k), last ? num_variables() : state_at(k + 1)};
    stages.stages.push_back({variables, {k == 0 ? 0 : rows_at(k), last ? num_constraints() : rows_at(k + 1)}});
  }
  return stages;
}

// xi_k: the prior's W, or the -1 of the interval before; what is measured; A.   w_k: G, drift
SparsePattern EstimationWindow::jacobian_pattern() const {
  SparsePattern pattern{num_constraints(), num_variables(), {0}, {}};
  const auto rows = [&](int begin, int count) {
    for (int r = 0; r < count; ++r) pattern.inner.push_back(begin + r);
  };
  for (int k = 0; k <= intervals_; ++k) {
    for (int c = 0; c < nx_; ++c) {
      if (k == 0)
        rows(0, nx_);
      else
        rows(rows_at(k) - nx_ + c, 1);
      rows(rows_at(k), ny_ + (k < intervals_ ? nx_ : 0));
      pattern.outer.push_back(pattern.nonzeros());
    }
    if (k == intervals_) break;
    for (std::size_t j = 0; j < rippling_.size(); ++j) {
      rows(rows_at(k) + ny_, nx_);
      pattern.outer.push_back(pattern.nonzeros());
    }
    for (const int i : drifting_) {
      rows(rows_at(k) + ny_ + i, 1);
      pattern.outer.push_back(pattern.nonzeros());
    }
  }
  return pattern;
}

SparsePattern EstimationWindow::hessian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int k = 0; k < intervals_; ++k) {
    for (int j = state_at(k) + nx_; j < state_at(k + 1); ++j) entries.emplace_back(j, j);
  }
  return SparsePattern::from_entries(num_variables(), num_variables(), std::move(entries));
}

void EstimationWindow::bounds(Bounds& bounds) const {
  bounds.c_lower.setZero();
  bounds.c_upper.setZero();
  bounds.compliance.head(nx_).setOnes();
  for (int k = 0; k <= intervals_; ++k) bounds.compliance.segment(rows_at(k), ny_).setOnes();
}

Nlp::Workspace EstimationWindow::make_workspace() const {
  return std::make_unique<Evaluation>(problem_, nx_, ny_, static_cast<int>(rippling_.size()), intervals_ + 1);
}

void EstimationWindow::prepare(ConstVectorRef x, Workspace& workspace) const {
  auto& evaluation = static_cast<Evaluation&>(*workspace);
  for (int k = 0; k <= intervals_; ++k) linearise(k, x, evaluation, evaluation.at[std::size_t(k)]);
}

double EstimationWindow::objective(ConstVectorRef x, Workspace&) const {
  double sum = 0;
  for (int k = 0; k < intervals_; ++k) sum += x.segment(state_at(k) + nx_, nw_).squaredNorm() / 2;
  return sum;
}

void EstimationWindow::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  gradient.setZero();
  for (int k = 0; k < intervals_; ++k) gradient.segment(state_at(k) + nx_, nw_) = x.segment(state_at(k) + nx_, nw_);
}

void EstimationWindow::constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const {
  auto& evaluation = static_cast<Evaluation&>(*workspace);
  evaluation.surprise = x.head(nx_) - prior_.mean;
  values.head(nx_).noalias() = whitening_ * evaluation.surprise;
  for (int k = 0; k <= intervals_; ++k) {
    const Linearised& here = evaluation.at[std::size_t(k)];
    values.segment(rows_at(k), ny_) = here.residual;
    if (k == intervals_) break;
    auto dynamics = values.segment(rows_at(k) + ny_, nx_);
    dynamics = here.next - x.segment(state_at(k + 1), nx_);
    int w = state_at(k) + nx_ + static_cast<int>(rippling_.size());
    for (const int i : drifting_) dynamics[i] += drift(i, k) * x[w++];
  }
}

void EstimationWindow::jacobian(ConstVectorRef, Workspace& workspace, std::span<double> values) const {
  const auto& at = static_cast<const Evaluation&>(*workspace).at;
  double* out = values.data();
  for (int k = 0; k <= intervals_; ++k) {
    const Linearised& here = at[std::size_t(k)];
    for (int c = 0; c < nx_; ++c) {
      if (k == 0)
        out = std::copy_n(whitening_.data() + c * nx_, nx_, out);
      else
        *out++ = -1;
      for (int j = 0; j < ny_; ++j) *out++ = here.gradients(c, j);
      if (k < intervals_) out = std::copy_n(here.a.data() + c * nx_, nx_, out);
    }
    if (k == intervals_) break;
    out = std::copy_n(here.g.data(), here.g.size(), out);
    for (const int i : drifting_) *out++ = drift(i, k);
  }
}

void EstimationWindow::hessian(ConstVectorRef, double sigma, ConstVectorRef, Workspace&, std::span<double> values) const {
  std::ranges::fill(values, sigma);
}

std::string EstimationWindow::variable_name(int i) const {
  const int k = std::min(i / stride_, intervals_), c = i - k * stride_;
  const int ripples = static_cast<int>(rippling_.size());
  const std::string instant = "[" + std::to_string(k) + "]";
  if (c < nx_) return problem_.dae->state_name(c) + instant;
  if (c < nx_ + ripples) return "ripple of " + problem_.dae->input_name(rippling_[std::size_t(c - nx_)]) + instant;
  return "drift of " + problem_.dae->state_name(drifting_[std::size_t(c - nx_ - ripples)]) + instant;
}

std::string EstimationWindow::constraint_name(int j) const {
  if (j < nx_) return "prior of " + problem_.dae->state_name(j);
  const int k = (j - nx_) / (ny_ + nx_), r = (j - nx_) % (ny_ + nx_);
  return (r < ny_ ? "measured " + problem_.measured->value_name(r) : problem_.dae->state_name(r - ny_)) + "[" + std::to_string(k) + "]";
}

}  // namespace tenon
