#include "tenon/core/consistent_start.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

namespace tenon {

namespace {

constexpr int kMaxIterations = 25;
constexpr double kStepTolerance = 1e-13;  // relative, of Newton's last step
constexpr double kRankTolerance = 1e-12;  // relative to the largest singular value, rows equilibrated

}  // namespace

std::string IndexDiagnosis::text() const {
  if (rank == size) return "of index 1";
  std::string text =
      "not of index 1: [dF/dxdot, dF/dy] has rank " + std::to_string(rank) + " of " + std::to_string(size) + "; dependent rows:";
  for (const std::string& row : rows) text += " " + row;
  return text;
}

struct ConsistentStart::Factorisation {
  Eigen::SparseLU<SparseMatrix> lu;
};

ConsistentStart::ConsistentStart(const Dae& dae)
    : dae_(dae), pattern_(dae.jacobian_pattern()), A_(pattern_.zero_matrix()), lu_(std::make_unique<Factorisation>()) {
  with_alpha_.resize(pattern_.inner.size());
  without_.resize(pattern_.inner.size());
  F_.resize(pattern_.rows);
  step_.resize(pattern_.rows);
}

void ConsistentStart::evaluate(const DaeState& state, Dae::Workspace& workspace) {
  const DaePoint at(state);
  dae_.residual(state.mode, at, workspace, F_);
  dae_.jacobian(state.mode, at, 1.0, workspace, with_alpha_);
  dae_.jacobian(state.mode, at, 0.0, workspace, without_);
  const int nx = dae_.num_states();
  for (int j = 0; j < pattern_.cols; ++j) {
    for (int k = pattern_.outer[static_cast<std::size_t>(j)]; k < pattern_.outer[static_cast<std::size_t>(j) + 1]; ++k) {
      const auto e = static_cast<std::size_t>(k);
      A_.valuePtr()[k] = j < nx ? with_alpha_[e] - without_[e] : without_[e];
    }
  }
}

ConsistentStart::~ConsistentStart() = default;

bool ConsistentStart::solve(DaeState& state, Dae::Workspace& workspace) {
  const int nx = dae_.num_states(), ny = dae_.num_algebraics();
  for (int k = 0; k < kMaxIterations; ++k) {
    evaluate(state, workspace);
    if (!F_.allFinite()) return false;
    Eigen::SparseLU<SparseMatrix>& lu = lu_->lu;
    if (k == 0) lu.analyzePattern(A_);
    lu.factorize(A_);
    if (lu.info() != Eigen::Success) return false;
    step_ = lu.solve(-F_);
    if (!step_.allFinite()) return false;
    state.xdot += step_.head(nx);
    state.y += step_.tail(ny);
    const double size = 1 + std::max(nx > 0 ? state.xdot.lpNorm<Eigen::Infinity>() : 0, ny > 0 ? state.y.lpNorm<Eigen::Infinity>() : 0);
    if (!std::isfinite(size)) return false;
    if (step_.lpNorm<Eigen::Infinity>() <= kStepTolerance * size || k + 1 == kMaxIterations) {
      dae_.residual(state.mode, DaePoint(state), workspace, F_);
      return F_.allFinite() && F_.lpNorm<Eigen::Infinity>() <= 1e-6 * size;
    }
  }
  return false;
}

IndexDiagnosis ConsistentStart::diagnose(const DaeState& state, Dae::Workspace& workspace) {
  evaluate(state, workspace);
  Eigen::MatrixXd A = A_;
  for (int i = 0; i < A.rows(); ++i) {
    const double largest = A.row(i).lpNorm<Eigen::Infinity>();
    if (largest > 0) A.row(i) /= largest;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU);
  IndexDiagnosis found{static_cast<int>(A.rows()), 0, {}};
  for (const double s : svd.singularValues()) found.rank += s > kRankTolerance * svd.singularValues()[0] ? 1 : 0;
  const int nx = dae_.num_states();
  for (int i = 0; i < found.size; ++i) {
    if (svd.matrixU().row(i).tail(found.size - found.rank).norm() <= 1e-6) continue;
    found.rows.push_back(i < nx ? dae_.state_name(i) : dae_.algebraic_name(i - nx));
  }
  return found;
}

bool make_consistent(const Dae& dae, ConsistentStart& newton, DaeState& state, Dae::Workspace& workspace) {
  if (!dae.has_derivatives()) return newton.solve(state, workspace);
  dae.derivatives(state.mode, state.t, state.x, state.u, workspace, state.xdot, state.y);
  return state.xdot.allFinite() && state.y.allFinite();
}

}  // namespace tenon
