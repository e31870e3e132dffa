#include "tenon/problems/envelope/attainable_set.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tenon/problems/envelope/rank_one_sum.hpp"
#include "tenon/problems/envelope/row_factor.hpp"

namespace tenon {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix62 = Eigen::Matrix<double, 6, 2>;

constexpr int kMaxLimits = 3;
constexpr int kMaxIterations = 60;
constexpr double kError = 1e-10;         // of gap, rows and stationarity, relative: where the iteration ends
constexpr double kAcceptedError = 1e-6;  // where it may end for lack of progress
constexpr double kRankTolerance = 1e-10;  // of the largest eigenvalue of K K'
constexpr double kLostTolerance = 1e-9;
constexpr double kGiveUp = 1e3;          // times the least error
constexpr double kToBoundary = 0.995;

/// The largest step in [0, 1] along dy that leaves a limit a share 1 - kToBoundary of its value at y.
double step_to(const RotorReach::Limit& limit, const Eigen::Vector2d& y, const Eigen::Vector2d& dy) {
  // kToBoundary g + s g'dy - s^2 c/2 |dy|^2 = 0, its positive root
  const double g = kToBoundary * limit.value(y), slope = limit.gradient(y).dot(dy), bend = 0.5 * limit.c * dy.squaredNorm();
  if (g + slope - bend >= 0) return 1;
  return 2 * g / (std::sqrt(slope * slope + 4 * bend * g) - slope);
}

/// The iterate of both programs and the step from it, numbered as in envelope.md.
class Iteration {
 public:
  /// (2.1) along a direction, (2.2) without one.
  Iteration(const std::vector<RotorReach>& rotors, const Wrench& from, const Wrench* direction)
      : rotors_(rotors), is_ray_(direction != nullptr), from_(from), direction_(is_ray_ ? *direction : Wrench::Zero()) {
    if (is_ray_) size_ = 0;
    for (const RotorReach& rotor : rotors_) {
      if (is_ray_) size_ += (rotor.columns().transpose() * direction_).norm() / direction_.squaredNorm();
      num_limits_ += rotor.num_limits();
    }
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      answer.y[i] = rotors_[i].centre();
      for_limits(i, [&](int j, double g, const Vector2&) { z_[i][j] = size_ / static_cast<double>(rotors_.size()) / g; });
    }
    wrench_size_ = std::max(from.norm(), size_ * direction_.norm());
  }

  /// Everything at the iterate that the steps need. Returns the largest of gap, stationarity (3.1) and what the rows lack, relative.
  double evaluate() {
    factor_ = {};
    lack_ = from_ + answer.length * direction_;
    gap_ = 0;
    double dual = 0;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      const RotorReach& rotor = rotors_[i];
      const Vector2& y = answer.y[i];
      lack_ -= rotor.columns() * y + rotor.miss(y);
      pull_[i] = rotor.columns().transpose() * answer.normal;
      RankOneSum H;  // (3.2)
      if (!is_ray_) {
        const RotorReach::Effort effort = rotor.effort(y);
        pull_[i] -= effort.gradient;
        H.add_identity(effort.across);
        H.add(effort.along - effort.across, effort.ahead);
      }
      if (!rotor.tilts()) H.add(1, {0, 1});
      Vector2 stationarity = pull_[i];
      for_limits(i, [&](int j, double g, const Vector2& slope) {
        H.add_identity(z_[i][j] * rotor.limit(j).c);
        H.add(z_[i][j] / g, slope);
        gap_ += z_[i][j] * g;
        stationarity += z_[i][j] * slope;
      });
      dual = std::max(dual, stationarity.lpNorm<Eigen::Infinity>());
      root_[i] = H.inverse_root();
      rows_[i] = rotor.columns() * root_[i];
    }
    return std::max({gap_ / size_, dual / size_, lack_.norm() / wrench_size_});
  }

  /// R of (3.2); a lost direction stands for itself, so that R is regular.
  void factor(const Eigen::Matrix<double, 6, Dynamic>& lost) {
    double largest = 0;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      for (int k = 0; k < 2; ++k) factor_.add(rows_[i].col(k));
      largest = std::max(largest, rows_[i].norm());
    }
    for (Eigen::Index k = 0; k < lost.cols(); ++k) factor_.add(largest * lost.col(k));
    factor_.factor();
    if (is_ray_) ray_ = factor_.solve(direction_);
  }

  /// (3.3) for z g = target, less the second-order terms of the step before where it corrects that. Returns how far it may be gone.
  double find_step(double target, bool corrects) {
    Vector2 push[kMaxRotors];
    Wrench right = lack_;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      push[i] = pull_[i];
      for_limits(i, [&](int j, double g, const Vector2& slope) {
        const double bend = 0.5 * rotors_[i].limit(j).c * dy_[i].squaredNorm();
        const double product = corrects ? target - dz_[i][j] * slope.dot(dy_[i]) + z_[i][j] * bend : target;
        push[i] += product / g * slope;
        dz_[i][j] = product / g - z_[i][j];
      });
      push[i] = root_[i].transpose() * push[i];
      right -= rows_[i] * push[i];
    }
    d_normal_.setZero();
    d_length_ = 0;
    turn(right, 1 - direction_.dot(answer.normal));
    Wrench left = lack_ + d_length_ * direction_;
    for (std::size_t i = 0; i < rotors_.size(); ++i) left -= rotors_[i].columns() * (root_[i] * (rows_[i].transpose() * d_normal_ + push[i]));
    turn(left, 0);  // what rounding has left
    double step = 1;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      dy_[i] = root_[i] * (rows_[i].transpose() * d_normal_ + push[i]);
      for_limits(i, [&](int j, double g, const Vector2& slope) {
        dz_[i][j] -= z_[i][j] / g * slope.dot(dy_[i]);
        step = std::min(step, step_to(rotors_[i].limit(j), answer.y[i], dy_[i]));
        if (dz_[i][j] < 0) step = std::min(step, -kToBoundary * z_[i][j] / dz_[i][j]);
      });
    }
    return step;
  }

  /// sum z g, now and after a part of the step.
  double gap() const { return gap_; }
  double gap_after(double step) const {
    double sum = 0;
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      for (int j = 0; j < rotors_[i].num_limits(); ++j) {
        sum += (z_[i][j] + step * dz_[i][j]) * rotors_[i].limit(j).value(answer.y[i] + step * dy_[i]);
      }
    }
    return sum;
  }

  void move(double step) {
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      answer.y[i] += step * dy_[i];
      for (int j = 0; j < rotors_[i].num_limits(); ++j) z_[i][j] += step * dz_[i][j];
    }
    answer.normal += step * d_normal_;
    answer.length += step * d_length_;
  }

  int num_limits() const { return num_limits_; }

  AttainableSet::Answer answer;

 private:
  using Vector2 = Eigen::Vector2d;

  /// f(j, g_ij, grad g_ij)
  template <class F>
  void for_limits(std::size_t i, F&& f) const {
    for (int j = 0; j < rotors_[i].num_limits(); ++j) {
      f(j, rotors_[i].limit(j).value(answer.y[i]), rotors_[i].limit(j).gradient(answer.y[i]));
    }
  }

  /// Adds S^-1 (right + dt d) to the step of the normal, with dt such that d'(this) = along.
  void turn(const Wrench& right, double along) {
    Wrench d_normal = factor_.solve(right);
    if (is_ray_) {
      const double dt = (along - direction_.dot(d_normal)) / direction_.dot(ray_);
      d_normal += dt * ray_;
      d_length_ += dt;
    }
    d_normal_ += d_normal;
  }

  const std::vector<RotorReach>& rotors_;
  bool is_ray_;
  Wrench from_, direction_;
  int num_limits_ = 0;
  double size_ = 1, wrench_size_;          // of the objective, of the rows
  double z_[kMaxRotors][kMaxLimits], dz_[kMaxRotors][kMaxLimits];
  Vector2 dy_[kMaxRotors];
  double gap_ = 0;
  Wrench lack_;                             // of the rows
  Vector2 pull_[kMaxRotors];                // K'lambda - grad phi
  Eigen::Matrix2d root_[kMaxRotors];        // L
  Matrix62 rows_[kMaxRotors];               // K L
  RowFactor factor_;
  Wrench ray_, d_normal_;                   // S^-1 d
  double d_length_ = 0;
};

}  // namespace

AttainableSet::AttainableSet(const std::vector<Rotor>& rotors) {
  Matrix6 gram = Matrix6::Zero();
  double arm = 0;  // m, so that forces and torques weigh alike
  for (const Rotor& rotor : rotors) {
    rotors_.emplace_back(rotor);
    arm = std::max(arm, rotor.position.norm());
    gram += rotors_.back().columns() * rotors_.back().columns().transpose();
  }
  Wrench scale;
  scale << 1, 1, 1, Eigen::Vector3d::Constant(arm > 0 ? 1 / arm : 1);
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(scale.asDiagonal() * gram * scale.asDiagonal());
  const Eigen::Index lost = (eigen.eigenvalues().array() <= kRankTolerance * eigen.eigenvalues()[5]).count();
  const Eigen::Matrix<double, 6, Dynamic> vectors = scale.asDiagonal() * eigen.eigenvectors().leftCols(lost);
  lost_ = vectors.householderQr().householderQ() * Eigen::MatrixXd::Identity(6, lost);
}

double AttainableSet::support(const Wrench& normal) const {
  double sum = 0;
  for (const RotorReach& rotor : rotors_) sum += rotor.support(normal);
  return sum;
}

double AttainableSet::deviation() const {
  double most = 0;
  for (const RotorReach& rotor : rotors_) most = std::max(most, rotor.deviation());
  return most;
}

bool AttainableSet::is_lost(const Wrench& wrench) const {
  return (lost_.transpose() * wrench).norm() > kLostTolerance * wrench.norm();
}

AttainableSet::Answer AttainableSet::farthest(const Wrench& from, const Wrench& direction) const {
  if (!is_lost(from) && !is_lost(direction)) return solve(from, &direction);
  Answer answer;
  answer.solved = !is_lost(from);
  return answer;
}

AttainableSet::Answer AttainableSet::least_effort(const Wrench& wrench) const {
  if (is_lost(wrench)) return {};
  return solve(wrench, nullptr);
}

AttainableSet::Answer AttainableSet::solve(const Wrench& from, const Wrench* direction) const {
  Iteration at(rotors_, from, direction);
  Answer best;
  double least_error = std::numeric_limits<double>::infinity();
  for (; at.answer.iterations < kMaxIterations; ++at.answer.iterations) {
    const double error = at.evaluate();
    if (!(error < kGiveUp * least_error)) break;  // rounding has the upper hand
    if (error < least_error) {
      least_error = error;
      best = at.answer;
    }
    if (error <= kError) break;
    at.factor(lost_);
    const double trial = at.find_step(0, false);
    const double share = std::clamp(at.gap_after(trial) / at.gap(), 0.0, 1.0);
    at.move(at.find_step(share * share * share * at.gap() / at.num_limits(), true));
  }
  best.solved = least_error <= kAcceptedError;
  return best;
}

}  // namespace tenon
