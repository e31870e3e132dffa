#include "tenon/solvers/least_squares_multipliers.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tenon/core/first_order.hpp"

namespace tenon {

namespace {

constexpr double kActive = 1e-4;   // relative distance at which a side counts as active
constexpr double kUseful = 1e-10;  // of the largest gradient entry: what a side must gain to be taken back

/// The sign a multiplier may have: +1 at an upper side, -1 at a lower one, 0 for any.
struct Side {
  bool is_row;
  int index;
  int sign;
};

void add_active_sides(std::vector<Side>& sides, bool is_row, const Vector& values, const Vector& lower, const Vector& upper) {
  const auto near = [](double value, double bound) {
    return std::isfinite(bound) && std::abs(value - bound) <= kActive * std::max(1.0, std::abs(bound));
  };
  for (int i = 0; i < values.size(); ++i) {
    if (lower[i] == upper[i]) {
      sides.push_back({is_row, i, 0});
      continue;
    }
    if (near(values[i], upper[i])) sides.push_back({is_row, i, 1});
    if (near(values[i], lower[i])) sides.push_back({is_row, i, -1});
  }
}

/// min |A mu + gradient| with sign_k mu_k >= 0: an active set that starts full, sheds wrong signs, and takes back what still helps
/// [Lawson & Hanson, Solving Least Squares Problems, 1974, ch. 23].
class SignedLeastSquares {
 public:
  SignedLeastSquares(const Eigen::MatrixXd& columns, const std::vector<Side>& sides, const Vector& gradient)
      : columns_(columns), sides_(sides), gradient_(gradient), used_(sides.size(), true) {}

  Vector solve() {
    shed_wrong_signs();
    for (std::size_t attempt = 0; attempt < sides_.size() && take_back_the_most_useful(); ++attempt) shed_wrong_signs();
    return mu_;
  }

 private:
  /// The least-squares multipliers of the used sides, 0 for the others.
  void solve_used() {
    std::vector<int> used;
    for (int k = 0; k < columns_.cols(); ++k) {
      if (used_[k]) used.push_back(k);
    }
    mu_.setZero(columns_.cols());
    if (used.empty()) return;
    const Eigen::MatrixXd matrix = columns_(Eigen::all, used);
    mu_(used) = matrix.colPivHouseholderQr().solve(-gradient_);
  }

  void shed_wrong_signs() {
    for (bool wrong = true; wrong;) {
      solve_used();
      wrong = false;
      for (int k = 0; k < columns_.cols(); ++k) {
        if (!used_[k] || sides_[k].sign * mu_[k] >= 0) continue;
        used_[k] = false;
        wrong = true;
      }
    }
  }

  /// Descent of the residual along the right sign of an unused side: -sign a'(A mu + gradient).
  bool take_back_the_most_useful() {
    const Vector gain = -columns_.transpose() * (columns_ * mu_ + gradient_);
    int best = -1;
    double best_gain = kUseful * std::max(1.0, gradient_.lpNorm<Eigen::Infinity>());
    for (int k = 0; k < columns_.cols(); ++k) {
      if (used_[k] || sides_[k].sign * gain[k] <= best_gain) continue;
      best = k;
      best_gain = sides_[k].sign * gain[k];
    }
    if (best >= 0) used_[best] = true;
    return best >= 0;
  }

  const Eigen::MatrixXd& columns_;  // n x sides: a row's gradient, or a unit vector
  const std::vector<Side>& sides_;
  const Vector& gradient_;
  std::vector<char> used_;
  Vector mu_;
};

}  // namespace

Point with_least_squares_multipliers(const Nlp& problem, const Bounds& bounds, const Vector& x) {
  Point point(problem.num_variables(), problem.num_constraints());
  point.x = x;
  const FirstOrder here(problem, x);
  if (!here.all_finite()) return point;

  std::vector<Side> sides;
  add_active_sides(sides, true, here.constraints, bounds.c_lower, bounds.c_upper);
  add_active_sides(sides, false, x, bounds.x_lower, bounds.x_upper);

  const Eigen::MatrixXd dense = here.jacobian;
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(x.size(), static_cast<Eigen::Index>(sides.size()));
  for (int k = 0; k < columns.cols(); ++k) {
    if (sides[k].is_row) columns.col(k) = dense.row(sides[k].index);
    else columns(sides[k].index, k) = 1;
  }
  const Vector mu = SignedLeastSquares(columns, sides, here.gradient).solve();

  for (int k = 0; k < columns.cols(); ++k) {
    (sides[k].is_row ? point.lambda : point.z)[sides[k].index] += mu[k];
  }
  return point;
}

}  // namespace tenon
