#include "tenon/solvers/hybrid/dop853_flow.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/solvers/hybrid/dop853_coefficients.hpp"

namespace tenon {

namespace {

using namespace dop853;

constexpr double kSafety = 0.9, kLeastFactor = 1.0 / 3, kMostFactor = 6.0;  // [HNW93, sec. II.4]
constexpr double kLeastStep = 1e-15;                                        // relative to the time itself
constexpr int kMaxRejections = 60;

class Dop853Flow final : public Flow {
 public:
  Dop853Flow(const Dae& dae, const IntegratorOptions& options)
      : dae_(dae), options_(options), newton_(dae), workspace_(dae.make_workspace()), at_(initial_state_of(dae)) {
    const int n = dae.num_states();
    stages_.setZero(n, kExtendedStages);
    powers_.setZero(n, kPowers);
    x_.setZero(n);
    x_next_.setZero(n);
    scale_.setOnes(n);
    f_.setZero(n);
  }

  bool restart(const DaeState& state) override {
    at_ = state;
    begin_ = end_ = state.t;
    x_ = x_next_ = state.x;
    f_ = state.xdot;
    if (h_ <= 0) h_ = first_step();
    return true;
  }

  Step step(double t_limit, double h_max) override {
    x_ = x_next_;
    begin_ = end_;
    stages_.col(0) = f_;
    for (int k = 0; k < kMaxRejections; ++k) {
      double h = std::min(h_, h_max);
      const double left = t_limit - begin_;
      const bool is_last = h >= left * (1 - 1e-12);
      if (is_last)
        h = left;
      else if (h > 0.5 * left)
        h = 0.5 * left;  // two equal steps rather than a full one and a crumb
      if (h <= kLeastStep * std::max(1.0, std::abs(begin_)) && !is_last) return Step::collapsed;
      const double error = try_step(begin_, x_, h, x_next_) ? error_norm(h) : 1e300;
      if (error <= 1) {
        end_ = is_last ? t_limit : begin_ + h;
        f_ = stages_.col(kStages);
        if (dae_.has_manifold(at_.mode) && !(project(end_, x_next_) && evaluate(end_, x_next_, f_, at_.y))) return Step::failed;
        const double factor = std::clamp(kSafety * std::pow(std::max(error, 1e-12), -1.0 / 8), kLeastFactor, kMostFactor);
        if (h >= 0.5 * h_ || factor < 1) h_ = h * factor;
        is_extended_ = false;
        ++steps_;
        return Step::taken;
      }
      ++rejected_;
      h_ = h * (error < 1e299 ? std::max(kLeastFactor, kSafety * std::pow(error, -1.0 / 8)) : 0.1);
    }
    return Step::collapsed;
  }

  bool interpolate(double t, DaeState& state) override {
    return interpolate_state(t, state) && project(t, state.x) && evaluate(t, state.x, state.xdot, state.y);
  }

  bool interpolate_state(double t, DaeState& state) override {
    state.t = t;
    if (t == end_) {
      state.x = x_next_;
    } else if (t == begin_) {
      state.x = x_;
    } else {
      if (!is_extended_ && !extend()) return false;
      // x(t) = x + s (F0 + (1-s) (F1 + s (F2 + (1-s) (F3 + ...))))  [HNW93, II.6]
      const double s = (t - begin_) / (end_ - begin_);
      state.x.setZero();
      for (int p = kPowers - 1; p >= 0; --p) state.x = (state.x + powers_.col(p)) * ((kPowers - 1 - p) % 2 == 0 ? s : 1 - s);
      state.x += x_;
    }
    return true;
  }

  bool land(double t, DaeState& state) override {
    if (t == end_ || t == begin_) return interpolate(t, state);
    const Vector last = stages_.col(kStages);  // of the whole step, for the interpolant
    const bool was_extended = is_extended_ || extend();
    const auto stages = stages_;
    const bool is_taken = was_extended && try_step(begin_, x_, t - begin_, landed_);
    stages_ = stages;
    state.t = t;
    state.x = landed_;
    return is_taken && evaluate(t, state.x, state.xdot, state.y);
  }

 private:
  bool evaluate(double t, ConstVectorRef x, VectorRef xdot, VectorRef y) {
    ++evaluations_;
    if (dae_.has_derivatives()) {
      dae_.derivatives(at_.mode, t, x, at_.u, workspace_, xdot, y);
      return xdot.allFinite();
    }
    at_.t = t;
    at_.x = x;
    if (!newton_.solve(at_, workspace_)) return false;
    xdot = at_.xdot;
    y = at_.y;
    return true;
  }

  bool project(double t, VectorRef x) { return !dae_.has_manifold(at_.mode) || dae_.project(at_.mode, t, x, workspace_); }

  /// The derivative of a stage into its column.
  bool evaluate_stage(int i, double t, ConstVectorRef x) { return evaluate(t, x, stages_.col(i), at_.y); }

  bool try_step(double t, const Vector& x, double h, Vector& next) {
    for (int i = 1; i <= kStages; ++i) {
      sum_ = stages_.leftCols(i) * Eigen::Map<const Vector>(kA.data() + row_of(i), i);
      next = x + h * sum_;
      if (!evaluate_stage(i, t + kC[static_cast<std::size_t>(i)] * h, next)) return false;
    }
    return next.allFinite();
  }

  double error_norm(double h) {
    scale_ = options_.atol + options_.rtol * x_.cwiseAbs().cwiseMax(x_next_.cwiseAbs()).array();
    const double n = std::max<double>(1, static_cast<double>(x_.size()));
    sum_ = stages_.leftCols(kStages) * Eigen::Map<const Vector>(kE5.data(), kStages);
    const double e5 = sum_.cwiseQuotient(scale_).squaredNorm();
    sum_ = stages_.leftCols(kStages) * Eigen::Map<const Vector>(kE3.data(), kStages);
    const double e3 = sum_.cwiseQuotient(scale_).squaredNorm();
    return e5 > 0 ? h * e5 / std::sqrt((e5 + 0.01 * e3) * n) : 0;
  }

  /// The three further stages of the continuous extension, and its powers.
  bool extend() {
    const double h = end_ - begin_;
    for (int i = kStages + 1; i < kExtendedStages; ++i) {
      sum_ = stages_.leftCols(i) * Eigen::Map<const Vector>(kA.data() + row_of(i), i);
      sum_ = x_ + h * sum_;
      if (!evaluate_stage(i, begin_ + kC[static_cast<std::size_t>(i)] * h, sum_)) return false;
    }
    const Vector change = x_next_ - x_;
    powers_.col(0) = change;
    powers_.col(1) = h * stages_.col(0) - change;
    powers_.col(2) = 2 * change - h * (stages_.col(kStages) + stages_.col(0));
    for (int p = 0; p < 4; ++p)
      powers_.col(3 + p) = h * stages_ * Eigen::Map<const Vector>(kD[static_cast<std::size_t>(p)].data(), kExtendedStages);
    is_extended_ = true;
    return true;
  }

  /// |h f| one hundredth of |x|, both in the norm of the tolerances  [HNW93, sec. II.4].
  double first_step() const {
    const Eigen::ArrayXd scale = options_.atol + options_.rtol * x_.cwiseAbs().array();
    const double d0 = (x_.array() / scale).matrix().norm(), d1 = (f_.array() / scale).matrix().norm();
    return d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1;
  }

  const Dae& dae_;
  IntegratorOptions options_;
  ConsistentStart newton_;
  Dae::Workspace workspace_;
  DaeState at_;  // mode and u of this flow; scratch otherwise
  Eigen::Matrix<double, Dynamic, Dynamic> stages_, powers_;
  Vector x_, x_next_, f_, scale_, sum_, landed_;
  double h_ = 0;
  bool is_extended_ = false;
};

}  // namespace

std::unique_ptr<Flow> make_dop853_flow(const Dae& dae, const IntegratorOptions& options) {
  return std::make_unique<Dop853Flow>(dae, options);
}

}  // namespace tenon
