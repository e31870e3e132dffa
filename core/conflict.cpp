#include "tenon/core/conflict.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/core/nonnegative_least_squares.hpp"

namespace tenon {

namespace {

constexpr double kViolated = 1e-9, kActive = 1e-6;  // relative to the size of the bound
constexpr double kCancelled = 1e-4;                 // what sum y a may keep of its terms: x is a stationary point only so far
constexpr double kWeight = 1e-6;                    // a share of the largest multiplier below this is rounding
constexpr double kMaxEntries = 4e6;                 // of the dense least-squares problem
constexpr double kMostWork = 4e9;                   // multiplications in it, some seconds

/// One side of a row or variable:  sign (value - bound) <= 0
struct Side {
  int index;  // row j, or variable i
  bool is_bound;
  double sign;  // +1: upper, -1: lower
  double room;  // b: distance to the bound, < 0 outside
  double size;  // of the bound
};

void add_sides(int index, bool is_bound, double value, double lower, double upper, std::vector<Side>& sides) {
  if (std::isfinite(upper)) sides.push_back({index, is_bound, 1, upper - value, std::max(1.0, std::abs(upper))});
  if (std::isfinite(lower)) sides.push_back({index, is_bound, -1, value - lower, std::max(1.0, std::abs(lower))});
}

class Contradiction {
 public:
  Contradiction(const Nlp& problem, const Vector& x)
      : problem_(problem), x_(x), here_(problem, x), rows_(here_.jacobian), bounds_(n(), m()) {
    problem.bounds(bounds_);
    for (const SoftRow& soft : problem.soft_rows()) bounds_.compliance[soft.row] = kInfinity<double>;
    for (int j = 0; j < m(); ++j) {
      if (bounds_.compliance[j] == 0) add_sides(j, false, here_.constraints[j], bounds_.c_lower[j], bounds_.c_upper[j], sides_);
    }
    for (int i = 0; i < n(); ++i) add_sides(i, true, x[i], bounds_.x_lower[i], bounds_.x_upper[i], sides_);
  }

  bool all_finite() const { return x_.allFinite() && here_.constraints.allFinite() && here_.jacobian.coeffs().allFinite(); }

  /// The sides outside by more than a relative distance, with the multipliers that prove it; empty where they contradict one another not.
  std::vector<Limit> among_sides_with_room_below(double relative) const {
    std::vector<Side> chosen;
    for (const Side& side : sides_) {
      // A bound may hold a violated row back: it belongs to it as soon as it is reached.
      const double reach = side.is_bound ? std::max(relative, kActive) : relative;
      if (side.room < reach * side.size) chosen.push_back(side);
    }
    const std::vector<int> place = places_of_variables(chosen);
    const int touched = 1 + (place.empty() ? -1 : *std::max_element(place.begin(), place.end()));
    if (chosen.empty() || double(touched + 1) * double(chosen.size()) > kMaxEntries) return {};

    // column k: (a_k ; b_k) / its length
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(touched + 1, std::ssize(chosen));
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      const Side& side = chosen[std::size_t(k)];
      for_each_entry(side, [&](int i, double a) { columns(place[std::size_t(i)], k) = side.sign * a; });
      columns(touched, k) = side.room;
    }
    const Vector length = columns.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    columns.array().rowwise() /= length.transpose().array();
    Vector target = Vector::Zero(touched + 1);
    target[touched] = -1;
    const Vector y = nonnegative_least_squares(columns, target, kMostWork);

    const Vector left = columns.topRows(touched) * y, terms = columns.topRows(touched).cwiseAbs() * y;
    const bool proven = columns.row(touched).dot(y) < -0.5 &&
                        (left.cwiseAbs().array() <= kCancelled * std::max(1.0, terms.size() > 0 ? terms.maxCoeff() : 0)).all();
    return proven ? limits(chosen, y, length) : std::vector<Limit>();
  }

  std::vector<Limit> violated(double tolerance) const {
    std::vector<Limit> found;
    for (const Side& side : sides_) {
      if (side.room < -tolerance) found.push_back(limit(side, 0));
    }
    sort(found);
    return found;
  }

 private:
  int n() const { return problem_.num_variables(); }
  int m() const { return problem_.num_constraints(); }

  template <class Visit>
  void for_each_entry(const Side& side, Visit&& visit) const {
    if (side.is_bound) return visit(side.index, 1.0);
    for (RowMajor::InnerIterator entry(rows_, side.index); entry; ++entry) visit(static_cast<int>(entry.col()), entry.value());
  }

  /// Variables that some side touches, numbered; -1 for the others.
  std::vector<int> places_of_variables(const std::vector<Side>& chosen) const {
    std::vector<int> place(static_cast<std::size_t>(n()), -1);
    int count = 0;
    for (const Side& side : chosen) {
      for_each_entry(side, [&](int i, double) {
        if (place[std::size_t(i)] < 0) place[std::size_t(i)] = count++;
      });
    }
    return place;
  }

  Limit limit(const Side& side, double y) const {
    const int i = side.index;
    Limit out = side.is_bound ? Limit{problem_.variable_name(i), true, x_[i], bounds_.x_lower[i], bounds_.x_upper[i]}
                              : Limit{problem_.constraint_name(i), false, here_.constraints[i], bounds_.c_lower[i], bounds_.c_upper[i]};
    out.violation = std::max(0.0, -side.room);
    out.multiplier = side.sign * y;
    return out;
  }

  /// The sides that carry weight; their multipliers in units of the rows, the largest 1.
  std::vector<Limit> limits(const std::vector<Side>& chosen, const Vector& y, const Vector& length) const {
    const Vector multipliers = y.cwiseQuotient(length);
    std::vector<Limit> found;
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      if (y[k] > kWeight * y.maxCoeff()) found.push_back(limit(chosen[std::size_t(k)], multipliers[k] / multipliers.maxCoeff()));
    }
    sort(found);
    return found;
  }

  static void sort(std::vector<Limit>& limits) {
    std::stable_sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.violation > b.violation; });
  }

  using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  const Nlp& problem_;
  const Vector& x_;
  FirstOrder here_;
  RowMajor rows_;
  Bounds bounds_;
  std::vector<Side> sides_;
};

}  // namespace

std::vector<Limit> conflict(const Nlp& problem, const Vector& x) {
  const Contradiction contradiction(problem, x);
  if (!contradiction.all_finite()) return {};
  // What is violated hurts first; then what is active may take part; at last all.
  for (const double relative : {-kViolated, kActive, kInfinity<double>}) {
    std::vector<Limit> found = contradiction.among_sides_with_room_below(relative);
    if (!found.empty()) return found;
  }
  return {};
}

std::vector<Limit> violated_limits(const Nlp& problem, const Vector& x, double tolerance) {
  return Contradiction(problem, x).violated(tolerance);
}

}  // namespace tenon
