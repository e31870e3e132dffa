#include "tenon/problems/envelope/attainable_set.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

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

/// H = alpha I + sum_j beta_j s_j s_j', and its inverse without cancellation, however far apart the terms are:
///     det H = alpha^2 + alpha sum_j beta_j |s_j|^2 + sum_{j<k} beta_j beta_k (s_j x s_k)^2,    adj H = alpha I + sum_j beta_j s_j^ s_j^'
class RankOneSum {
 public:
  void add_identity(double alpha) {
    determinant_ += alpha * (alpha + 2 * alpha_ + squares_);
    alpha_ += alpha;
    adjugate_.diagonal().array() += alpha;
  }
  void add(double beta, const Eigen::Vector2d& s) {
    const Eigen::Vector2d across(-s[1], s[0]);
    determinant_ += beta * across.dot(outer_ * across) + alpha_ * beta * s.squaredNorm();
    outer_ += beta * s * s.transpose();
    squares_ += beta * s.squaredNorm();
    adjugate_ += beta * across * across.transpose();
  }
  /// L with L L' = H^-1, lower triangular.
  Eigen::Matrix2d inverse_root() const {
    const double first = std::sqrt(adjugate_(0, 0) / determinant_);
    return Eigen::Matrix2d{{first, 0}, {adjugate_(1, 0) / (determinant_ * first), 1 / std::sqrt(adjugate_(0, 0))}};
  }

 private:
  double alpha_ = 0, squares_ = 0, determinant_ = 0;  // squares: sum_j beta_j |s_j|^2
  Eigen::Matrix2d outer_ = Eigen::Matrix2d::Zero(), adjugate_ = Eigen::Matrix2d::Zero();
};

/// R with R'R = sum of a a' over the rows a that were added, by Householder's reflections of the rows and not of their squares: kinked
/// rotors and saturated ones make them differ by as much as the gap is small.
class RowFactor {
 public:
  void add(const Wrench& row) { rows_[count_++] = row; }

  void factor() {
    for (int k = 0; k < 6; ++k) {
      double square = 0;
      for (int r = k; r < count_; ++r) square += rows_[r][k] * rows_[r][k];
      const double head = rows_[k][k], length = head > 0 ? -std::sqrt(square) : std::sqrt(square);
      // v = a - length e_k,    a_j <- a_j - (v'a_j) v / (v'v/2),    v'v/2 = length (length - head)
      const double half = length * (length - head);
      rows_[k][k] = head - length;
      Wrench product = Wrench::Zero();
      for (int r = k; r < count_; ++r) product += rows_[r][k] * rows_[r];
      product /= half;
      product[k] = 0;
      for (int r = k; r < count_; ++r) rows_[r] -= rows_[r][k] * product;
      rows_[k][k] = length;
    }
  }

  /// x of R'R x = b.
  Wrench solve(Wrench b) const {
    for (int k = 0; k < 6; ++k) {
      b[k] /= rows_[k][k];
      for (int j = k + 1; j < 6; ++j) b[j] -= rows_[k][j] * b[k];
    }
    for (int k = 5; k >= 0; --k) {
      for (int j = k + 1; j < 6; ++j) b[k] -= rows_[k][j] * b[j];
      b[k] /= rows_[k][k];
    }
    return b;
  }

 private:
  Wrench rows_[2 * kMaxRotors + 6];
  int count_ = 0;
};

/// The largest step in [0, 1] along dy that leaves a limit a share 1 - kToBoundary of its value at y.
double step_to(const RotorReach::Limit& limit, const Eigen::Vector2d& y, const Eigen::Vector2d& dy) {
  // kToBoundary g + s g'dy - s^2 c/2 |dy|^2 = 0, its positive root
  const double g = kToBoundary * limit.value(y), slope = limit.gradient(y).dot(dy), bend = 0.5 * limit.c * dy.squaredNorm();
  if (g + slope - bend >= 0) return 1;
  return 2 * g / (std::sqrt(slope * slope + 4 * bend * g) - slope);
}

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

/// The loop of both programs: with a direction (2.1), without one (2.2). Names and numbers as in envelope.md, section 3.
AttainableSet::Answer AttainableSet::solve(const Wrench& from, const Wrench* direction) const {
  const auto count = rotors_.size();
  Answer at;
  auto& y = at.y;
  double z[kMaxRotors][kMaxLimits], dz[kMaxRotors][kMaxLimits] = {};
  Eigen::Vector2d dy[kMaxRotors];

  double size = 1;  // of the objective
  if (direction != nullptr) {
    size = 0;
    for (const RotorReach& rotor : rotors_) size += (rotor.columns().transpose() * *direction).norm() / direction->squaredNorm();
  }
  int limits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    y[i] = rotors_[i].centre();
    for (int j = 0; j < rotors_[i].num_limits(); ++j, ++limits) z[i][j] = size / static_cast<double>(count) / rotors_[i].limit(j).value(y[i]);
  }
  const double force_size = std::max(from.norm(), direction != nullptr ? size * direction->norm() : 0);

  Answer best;
  double least_error = std::numeric_limits<double>::infinity();
  for (; at.iterations < kMaxIterations; ++at.iterations) {
    // (3.2)  S = sum_i K_i H_i^-1 K_i',  and what the rows lack
    RowFactor factor;
    double largest = 0;
    Wrench lack = from;
    if (direction != nullptr) lack += at.length * *direction;
    Matrix62 KL[kMaxRotors];  // H = (L L')^-1
    Eigen::Matrix2d root[kMaxRotors];
    Eigen::Vector2d pull[kMaxRotors];  // K'lambda less the gradient of the effort
    double gap = 0, dual = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const RotorReach& rotor = rotors_[i];
      const Matrix62& K = rotor.columns();
      lack -= K * y[i] + rotor.miss(y[i]);
      pull[i] = K.transpose() * at.normal;
      RankOneSum H;
      if (direction == nullptr) {
        const RotorReach::Effort effort = rotor.effort(y[i]);
        pull[i] -= effort.gradient;
        H.add_identity(effort.across);
        H.add(effort.along - effort.across, effort.ahead);
      }
      if (!rotor.tilts()) H.add(1, {0, 1});
      Eigen::Vector2d stationarity = pull[i];
      for (int j = 0; j < rotor.num_limits(); ++j) {
        const RotorReach::Limit& limit = rotor.limit(j);
        const double g = limit.value(y[i]);
        const Eigen::Vector2d slope = limit.gradient(y[i]);
        H.add_identity(z[i][j] * limit.c);
        H.add(z[i][j] / g, slope);
        gap += z[i][j] * g;
        stationarity += z[i][j] * slope;
      }
      dual = std::max(dual, stationarity.lpNorm<Eigen::Infinity>());
      root[i] = H.inverse_root();
      KL[i] = K * root[i];
      for (int k = 0; k < 2; ++k) factor.add(KL[i].col(k)), largest = std::max(largest, KL[i].col(k).norm());
    }
    const double error = std::max({gap / size, dual / size, lack.norm() / force_size});
    if (!(error < kGiveUp * least_error)) break;  // rounding has the upper hand
    if (error < least_error) {
      least_error = error;
      best = at;
    }
    if (error <= kError) break;
    for (Eigen::Index k = 0; k < lost_.cols(); ++k) factor.add(largest * lost_.col(k));
    factor.factor();
    Wrench ray = Wrench::Zero();
    if (direction != nullptr) ray = factor.solve(*direction);

    // One solve for a wanted product z g = target - correction, step by step: (3.3)
    Wrench turn;  // of the normal
    double dt = 0;
    const auto find_step = [&](double target, bool corrects) {
      Wrench right = lack;
      Eigen::Vector2d push[kMaxRotors];
      for (std::size_t i = 0; i < count; ++i) {
        push[i] = pull[i];
        for (int j = 0; j < rotors_[i].num_limits(); ++j) {
          const RotorReach::Limit& limit = rotors_[i].limit(j);
          const double g = limit.value(y[i]);
          double product = target;
          if (corrects) {
            const double bend = 0.5 * limit.c * dy[i].squaredNorm(), dg = limit.gradient(y[i]).dot(dy[i]);
            product -= dz[i][j] * dg - z[i][j] * bend;
          }
          push[i] += product / g * limit.gradient(y[i]);
          dz[i][j] = product / g - z[i][j];
        }
        right -= KL[i] * (root[i].transpose() * push[i]);
      }
      turn = factor.solve(right);
      if (direction != nullptr) {
        dt = (1 - direction->dot(at.normal + turn)) / direction->dot(ray);
        turn += dt * ray;
      }
      Wrench left = lack + dt * (direction != nullptr ? *direction : Wrench::Zero());
      for (std::size_t i = 0; i < count; ++i) {
        dy[i] = root[i] * (KL[i].transpose() * turn + root[i].transpose() * push[i]);
        left -= rotors_[i].columns() * dy[i];
      }
      Wrench extra = factor.solve(left);
      if (direction != nullptr) {
        const double ddt = -direction->dot(extra) / direction->dot(ray);
        dt += ddt;
        extra += ddt * ray;
      }
      turn += extra;
      double step = 1;
      for (std::size_t i = 0; i < count; ++i) {
        dy[i] += root[i] * (KL[i].transpose() * extra);
        for (int j = 0; j < rotors_[i].num_limits(); ++j) {
          const RotorReach::Limit& limit = rotors_[i].limit(j);
          dz[i][j] -= z[i][j] / limit.value(y[i]) * limit.gradient(y[i]).dot(dy[i]);
          step = std::min(step, step_to(limit, y[i], dy[i]));
          if (dz[i][j] < 0) step = std::min(step, -kToBoundary * z[i][j] / dz[i][j]);
        }
      }
      return step;
    };
    const double mu = gap / limits;
    const double trial = find_step(0, false);
    double ahead = 0;  // the gap after the trial step
    for (std::size_t i = 0; i < count; ++i) {
      for (int j = 0; j < rotors_[i].num_limits(); ++j) ahead += (z[i][j] + trial * dz[i][j]) * rotors_[i].limit(j).value(y[i] + trial * dy[i]);
    }
    const double share = std::clamp(ahead / gap, 0.0, 1.0);
    const double step = find_step(share * share * share * mu, true);
    for (std::size_t i = 0; i < count; ++i) {
      y[i] += step * dy[i];
      for (int j = 0; j < rotors_[i].num_limits(); ++j) z[i][j] += step * dz[i][j];
    }
    at.normal += step * turn;
    at.length += step * dt;
  }
  best.solved = least_error <= kAcceptedError;
  return best;
}

}  // namespace tenon
