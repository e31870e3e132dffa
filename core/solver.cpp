#include "tenon/core/solver.hpp"

#include <stdexcept>

namespace tenon {

namespace {

bool is_interval(double lower, double upper) {
  return lower <= upper && lower != kInfinity<double> && upper != -kInfinity<double>;
}

[[noreturn]] void reject_interval(const std::string& name, double lower, double upper) {
  throw std::invalid_argument("bounds of " + name + " are [" + std::to_string(lower) + ", " + std::to_string(upper) +
                              "] (expected lower <= upper, not NaN)");
}

void validate_length(const std::string& name, Eigen::Index found, Eigen::Index expected) {
  if (found != expected) {
    throw std::invalid_argument("point." + name + " has " + std::to_string(found) + " entries (expected " + std::to_string(expected) + ")");
  }
}

}  // namespace

void validate(const Nlp& problem, const Bounds& bounds) {
  for (int i = 0; i < problem.num_variables(); ++i) {
    if (!is_interval(bounds.x_lower[i], bounds.x_upper[i])) reject_interval(problem.variable_name(i), bounds.x_lower[i], bounds.x_upper[i]);
  }
  for (int j = 0; j < problem.num_constraints(); ++j) {
    if (!is_interval(bounds.c_lower[j], bounds.c_upper[j])) reject_interval(problem.constraint_name(j), bounds.c_lower[j], bounds.c_upper[j]);
    if (!(bounds.compliance[j] >= 0)) {
      throw std::invalid_argument("compliance of " + problem.constraint_name(j) + " is " + std::to_string(bounds.compliance[j]) +
                                  " (expected 0 or more)");
    }
  }
}

void refuse_soft_rows(const Nlp& problem) {
  const std::vector<SoftRow> soft = problem.soft_rows();
  if (soft.empty()) return;
  throw std::invalid_argument("row " + problem.constraint_name(soft.front().row) + " of " + problem.name() +
                              " is soft (expected make_solver, or WithSoftRows around the problem)");
}

void validate(const Nlp& problem, const Point& point) {
  validate_length("x", point.x.size(), problem.num_variables());
  validate_length("lambda", point.lambda.size(), problem.num_constraints());
  validate_length("z", point.z.size(), problem.num_variables());
}

}  // namespace tenon
