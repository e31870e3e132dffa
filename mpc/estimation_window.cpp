#include "tenon/mpc/estimation_window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tenon {

namespace {

Eigen::MatrixXd identity(int n) {
  return Eigen::MatrixXd::Identity(n, n);
}

}  // namespace

EstimationWindow::EstimationWindow(const EstimationProblem& problem)
    : problem_(problem),
      nx_(problem.dae->num_states()),
      ny_(problem.measured->num_values()),
      intervals_(problem.window),
      nw_(static_cast<int>((problem.ripple.array() > 0).count() + (problem.drift.array() > 0).count())),
      stride_(nx_ + nw_),
      scale_(problem.deviation),
      instants_(std::size_t(intervals_) + 1, {0, Vector::Zero(problem.dae->num_inputs()), Vector::Zero(ny_), Vector::Zero(ny_)}),
      prior_(Vector::Zero(nx_), identity(nx_)),
      now_(prior_),
      factor_(nx_),
      whitening_(identity(nx_)),
      variance_(Vector::Zero(nx_)) {
  for (int j = 0; j < problem.ripple.size(); ++j) {
    if (problem.ripple[j] > 0) rippling_.push_back(j);
  }
  for (int i = 0; i < nx_; ++i) {
    if (problem.drift[i] > 0) drifting_.push_back(i);
    if (problem.is_positive[std::size_t(i)]) scale_[i] /= problem.mean[i];
  }
  own_ = make_workspace();
  reset();
}

void EstimationWindow::reset() {
  for (Instant& instant : instants_) instant.dt = 0, instant.weights.setZero();
  forget();
}

void EstimationWindow::forget() {
  for (int i = 0; i < nx_; ++i)
    prior_.mean[i] = (problem_.is_positive[std::size_t(i)] ? std::log(problem_.mean[i]) : problem_.mean[i]) / scale_[i];
  prior_.covariance.setIdentity();
  whiten();
}

void EstimationWindow::slide(ConstVectorRef x, double dt, ConstVectorRef commands, ConstVectorRef measurements) {
  auto& evaluation = static_cast<Evaluation&>(*own_);
  Linearised& first = evaluation.at[0];
  linearise(0, x, evaluation, first);
  learn(0, x, first, prior_);
  move(0, x, first, prior_);
  if (!whiten()) forget();

  std::ranges::rotate(instants_, instants_.begin() + 1);
  Instant& last = instants_.back();
  last.dt = dt;
  last.commands = commands;
  for (int i = 0; i < ny_; ++i) {
    const bool is_measured = std::isfinite(measurements[i]);
    last.measured[i] = is_measured ? measurements[i] : 0;
    last.weights[i] = is_measured ? 1 / problem_.noise[i] : 0;
  }
}

void EstimationWindow::shift(Vector& x, Vector& lambda) {
  auto& evaluation = static_cast<Evaluation&>(*own_);
  std::copy(x.begin() + stride_, x.end(), x.begin());
  std::copy(lambda.begin() + rows_at(1), lambda.end(), lambda.begin() + rows_at(0));
  lambda.tail(ny_ + nx_).setZero();
  x.segment(state_at(intervals_) - nw_, nw_).setZero();
  lead_on(intervals_ - 1, x, evaluation);
}

void EstimationWindow::start(Vector& x) {
  start(x, static_cast<Evaluation&>(*own_));
}

void EstimationWindow::initial_point(VectorRef x) const {
  const Workspace workspace = make_workspace();
  start(x, static_cast<Evaluation&>(*workspace));
}

void EstimationWindow::start(VectorRef x, Evaluation& evaluation) const {
  x.setZero();
  x.head(nx_) = prior_.mean;
  for (int k = 0; k < intervals_; ++k) lead_on(k, x, evaluation);
}

// xi_{k+1}, without drift
void EstimationWindow::lead_on(int k, VectorRef x, Evaluation& evaluation) const {
  linearise(k, x, evaluation, evaluation.at[0]);
  x.segment(state_at(k + 1), nx_) = evaluation.at[0].next;
}

// P = L L',  W = L^-1
bool EstimationWindow::whiten() {
  if (!prior_.mean.allFinite() || !prior_.covariance.allFinite()) return false;
  factor_.compute(prior_.covariance);
  if (factor_.info() != Eigen::Success) return false;
  whitening_.setIdentity();
  factor_.matrixL().solveInPlace(whitening_);
  return true;
}

double EstimationWindow::drift(int i, int k) const {
  return problem_.drift[i] / problem_.deviation[i] * std::sqrt(instant(k + 1).dt);
}

void EstimationWindow::to_state(ConstVectorRef xi, VectorRef x, VectorRef slope) const {
  for (int i = 0; i < nx_; ++i) {
    const bool is_positive = problem_.is_positive[std::size_t(i)];
    x[i] = is_positive ? std::exp(scale_[i] * xi[i]) : scale_[i] * xi[i];
    slope[i] = is_positive ? scale_[i] * x[i] : scale_[i];
  }
}

// r = (h(x) - y) / noise,   next = phi(x, u + ripple w)
void EstimationWindow::linearise(int k, ConstVectorRef x, Evaluation& at, Linearised& out) const {
  const Instant& here = instant(k);
  to_state(state(x, k), at.z.head(nx_), at.slope);
  at.z.tail(at.z.size() - nx_) = here.commands;
  problem_.measured->values(at.z, out.residual);
  problem_.measured->jacobian(at.z, at.by_z);
  out.residual = here.weights.cwiseProduct(out.residual - here.measured);
  for (int j = 0; j < ny_; ++j) {
    for (int c = 0; c < nx_; ++c) out.gradients(c, j) = here.weights[j] * at.by_z(j, c) * at.slope[c];
  }
  if (k == intervals_) return;
  const int ripples = static_cast<int>(rippling_.size());
  at.command = instant(k + 1).commands;
  for (int j = 0; j < ripples; ++j) at.command[rippling_[std::size_t(j)]] += problem_.ripple[rippling_[std::size_t(j)]] * ripple(x, k)[j];
  at.transition.advance(at.z.head(nx_), at.command, instant(k + 1).dt);
  out.a.noalias() = at.transition.derivative.leftCols(nx_) * at.slope.asDiagonal();
  for (int j = 0; j < ripples; ++j) {
    const int u = rippling_[std::size_t(j)];
    out.g.col(j) = problem_.ripple[u] * at.transition.derivative.col(nx_ + u);
  }
  for (int i = 0; i < nx_; ++i) {
    const double next = at.transition.state[i];
    const bool is_positive = problem_.is_positive[std::size_t(i)];
    out.next[i] = (is_positive ? std::log(next) : next) / scale_[i];
    const double unit = is_positive ? scale_[i] * next : scale_[i];
    out.a.row(i) /= unit;
    out.g.row(i) /= unit;
  }
}

// r + g' (xi - x) = e
void EstimationWindow::learn(int k, ConstVectorRef x, const Linearised& at, GaussianBelief& belief) const {
  for (int i = 0; i < ny_; ++i) {
    if (instant(k).weights[i] == 0) continue;
    belief.learn(at.gradients.col(i), at.gradients.col(i).dot(state(x, k)) - at.residual[i]);
  }
}

void EstimationWindow::move(int k, ConstVectorRef x, const Linearised& at, GaussianBelief& belief) {
  variance_.setZero();
  for (const int i : drifting_) variance_[i] = drift(i, k) * drift(i, k);
  belief.move(at.a, at.g, state(x, k), ripple(x, k), at.next, variance_);
}

const GaussianBelief& EstimationWindow::belief(ConstVectorRef x) {
  prepare(x, own_);
  const auto& at = static_cast<const Evaluation&>(*own_).at;
  now_ = prior_;
  for (int k = 0; k <= intervals_; ++k) {
    learn(k, x, at[std::size_t(k)], now_);
    if (k < intervals_) move(k, x, at[std::size_t(k)], now_);
  }
  return now_;
}

}  // namespace tenon
