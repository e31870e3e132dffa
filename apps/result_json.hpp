// The result of a solve as INTERFACES has it: the fields that `solve --json` and `compare --json` share.
#pragma once

#include "tenon/apps/json.hpp"
#include "tenon/apps/measure.hpp"

namespace tenon {

/// Rows and bounds that x violates by more than the tolerance, worst first.
struct Violation {
  std::string name;
  double value = 0;  // of the row or variable
  double lower = 0, upper = 0;
  double violation = 0;
};
std::vector<Violation> violations(const Nlp& problem, const Vector& x, double tolerance);

/// Their names and violations.
Json violations_json(const Nlp& problem, const Vector& x, double tolerance);

Json residual_json(const KktResidual& residual);
Json evaluations_json(const EvaluationCounts& counts);

/// schema, problem, solver, status, objective, iterations, time_s, residual, evaluations, x, lambda, z; infeasible_constraints where they
/// hurt.
Json result_json(const Nlp& problem, const Measurement& measurement, double tolerance);

}  // namespace tenon
