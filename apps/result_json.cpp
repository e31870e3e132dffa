#include "tenon/apps/result_json.hpp"

#include <algorithm>

namespace tenon {

std::vector<Violation> violations(const Nlp& problem, const Vector& x, double tolerance) {
  const int n = problem.num_variables(), m = problem.num_constraints();
  Bounds bounds(n, m);
  problem.bounds(bounds);
  Nlp::Workspace workspace = problem.make_workspace();
  Vector rows(m);
  problem.prepare(x, workspace);
  problem.constraints(x, workspace, rows);

  std::vector<Violation> found;
  const auto look = [&](const std::string& name, double value, double lower, double upper) {
    const double violation = std::max(lower - value, value - upper);
    if (violation > tolerance) found.push_back({name, value, lower, upper, violation});
  };
  for (int i = 0; i < n; ++i) look(problem.variable_name(i), x[i], bounds.x_lower[i], bounds.x_upper[i]);
  for (int j = 0; j < m; ++j) {
    if (bounds.compliance[j] == 0) look(problem.constraint_name(j), rows[j], bounds.c_lower[j], bounds.c_upper[j]);
  }
  std::stable_sort(found.begin(), found.end(), [](const Violation& a, const Violation& b) { return a.violation > b.violation; });
  return found;
}

Json violations_json(const Nlp& problem, const Vector& x, double tolerance) {
  Json list = Json::array();
  for (const Violation& v : violations(problem, x, tolerance)) {
    list.push(Json::object().set("name", v.name).set("violation", v.violation));
  }
  return list;
}

Json residual_json(const KktResidual& residual) {
  return Json::object()
      .set("stationarity", residual.stationarity)
      .set("primal", residual.primal)
      .set("complementarity", residual.complementarity)
      .set("scale", residual.scale);
}

Json evaluations_json(const EvaluationCounts& counts) {
  return Json::object()
      .set("points", counts.prepare)
      .set("objective", counts.objective)
      .set("gradient", counts.gradient)
      .set("constraints", counts.constraints)
      .set("jacobian", counts.jacobian)
      .set("hessian", counts.hessian);
}

Json result_json(const Nlp& problem, const Measurement& measurement, double tolerance) {
  const Result& result = measurement.result;
  Json json = Json::object();
  json.set("schema", 1).set("problem", problem.name()).set("solver", measurement.solver).set("status", to_string(result.status));
  json.set("objective", result.objective).set("iterations", result.iterations).set("time_s", measurement.time);
  json.set("residual", residual_json(result.residual)).set("evaluations", evaluations_json(measurement.counts));
  json.set("x", measurement.point.x).set("lambda", measurement.point.lambda).set("z", measurement.point.z);
  if (result.status == Status::infeasible) json.set("infeasible_constraints", violations_json(problem, measurement.point.x, tolerance));
  return json;
}

}  // namespace tenon
