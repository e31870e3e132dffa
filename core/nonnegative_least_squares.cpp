#include "tenon/core/nonnegative_least_squares.hpp"

#include <vector>

namespace tenon {

namespace {

constexpr double kOptimal = 1e-12;  // a column whose slope is smaller, relative to its length and b's, does not enter

/// The unconstrained minimiser over some columns.
Vector least_squares(const Eigen::MatrixXd& A, const std::vector<int>& columns, const Vector& b) {
  return Eigen::MatrixXd(A(Eigen::all, columns)).colPivHouseholderQr().solve(b);
}

/// The column that descends steepest, none of the refused; -1 where none does.
int entering_column(const Eigen::MatrixXd& A, const Vector& residual, double threshold, const std::vector<bool>& refused) {
  const Vector slope = A.transpose() * residual;
  int best = -1;
  for (int k = 0; k < slope.size(); ++k) {
    if (!refused[std::size_t(k)] && slope[k] > threshold && (best < 0 || slope[k] > slope[best])) best = k;
  }
  return best;
}

}  // namespace

Vector nonnegative_least_squares(const Eigen::MatrixXd& A, const Vector& b, double most_work) {
  Vector y = Vector::Zero(A.cols());
  if (A.cols() == 0) return y;
  const double threshold = kOptimal * b.norm() * A.colwise().norm().maxCoeff();
  std::vector<int> positive;                                      // the columns where y > 0
  std::vector<bool> refused(static_cast<std::size_t>(A.cols()));  // positive already, or found to be dependent on those
  double work = 0;
  for (Eigen::Index round = 0; round < 3 * A.cols() && work < most_work; ++round) {
    const int entering = entering_column(A, b - A * y, threshold, refused);
    if (entering < 0) break;
    refused[std::size_t(entering)] = true;
    positive.push_back(entering);
    work += static_cast<double>(A.size()) + static_cast<double>(A.rows()) * static_cast<double>(positive.size() * positive.size());
    Vector target = least_squares(A, positive, b);
    if (target[target.size() - 1] <= 0) {
      positive.pop_back();
      continue;
    }
    // From y towards the target; what crosses 0 first leaves.
    while (target.minCoeff() <= 0) {
      double alpha = 1;
      std::size_t first = 0;
      for (std::size_t i = 0; i < positive.size(); ++i) {
        const double at = y[positive[i]], to = target[Eigen::Index(i)];
        if (to <= 0 && at / (at - to) <= alpha) alpha = at / (at - to), first = i;
      }
      for (std::size_t i = 0; i < positive.size(); ++i) y[positive[i]] += alpha * (target[Eigen::Index(i)] - y[positive[i]]);
      y[positive[first]] = 0;
      refused[std::size_t(positive[first])] = false;
      positive.erase(positive.begin() + static_cast<std::ptrdiff_t>(first));
      target = least_squares(A, positive, b);
    }
    for (std::size_t i = 0; i < positive.size(); ++i) y[positive[i]] = target[Eigen::Index(i)];
  }
  return y;
}

}  // namespace tenon
