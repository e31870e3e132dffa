#include "tenon/core/multi_start.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace tenon {

namespace {

constexpr double kReach = 10;   // r
constexpr double kSame = 1e-4;  // relative distance of two answers that are one

Point random_start(const Bounds& bounds, const Point& centre, std::mt19937_64& random) {
  Point start(static_cast<int>(centre.x.size()), static_cast<int>(centre.lambda.size()));
  for (Eigen::Index i = 0; i < start.x.size(); ++i) {
    const double middle = std::min(std::max(centre.x[i], bounds.x_lower[i]), bounds.x_upper[i]);
    const double reach = kReach * std::max(1.0, std::abs(middle));
    const double low = std::max(bounds.x_lower[i], middle - reach), high = std::min(bounds.x_upper[i], middle + reach);
    // from the bits themselves: the standard's distributions are not the same everywhere
    start.x[i] = low + (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);
  }
  return start;
}

bool is_same(const Vector& a, const Vector& b) {
  return ((a - b).array().abs() <= kSame * a.array().abs().max(1.0)).all();
}

void add_solution(std::vector<Optimum>& optima, Optimum&& found) {
  for (Optimum& known : optima) {
    if (!is_same(known.point.x, found.point.x)) continue;
    ++known.found;
    return;
  }
  optima.push_back(std::move(found));
}

}  // namespace

MultiStart multi_start(const Nlp& problem, Solver& solver, const Point& start, int starts, std::uint64_t seed) {
  if (starts < 1) throw std::invalid_argument("multi_start: " + std::to_string(starts) + " starts (expected 1 or more)");
  validate(problem, start);
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);
  std::mt19937_64 random(seed);

  MultiStart out;
  std::vector<Optimum> failures;  // the best of them alone
  for (int k = 0; k < starts; ++k) {
    Optimum end;
    end.start = k == 0 ? start : random_start(bounds, start, random);
    end.point = end.start;
    end.result = solver.solve(end.point);
    ++out.starts;
    const Status status = end.result.status;
    if (succeeded(status)) {
      add_solution(out.optima, std::move(end));
    } else {
      ++out.failed;
      if (failures.empty())
        failures.push_back(std::move(end));
      else if (end.result.residual.max_scaled() < failures[0].result.residual.max_scaled())
        failures[0] = std::move(end);
    }
    if (status == Status::stopped) break;
  }
  if (out.optima.empty()) out.optima = std::move(failures);
  std::ranges::stable_sort(out.optima, {}, [](const Optimum& optimum) { return optimum.result.objective; });
  return out;
}

}  // namespace tenon
