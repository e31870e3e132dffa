#include "tenon/apps/result_json.hpp"

#include "tenon/core/explanation.hpp"

namespace tenon {

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

void set_explanation(Json& json, const Nlp& problem, const Measurement& measurement) {
  const Explanation explanation = explain(problem, measurement.point, measurement.result);
  json.set("explanation", explanation.sentences);
  if (measurement.result.status != Status::infeasible) return;
  Json list = Json::array();
  for (const Limit& limit : explanation.conflict) {
    list.push(Json::object()
                  .set("name", limit.name)
                  .set("kind", limit.is_bound ? "bound" : "row")
                  .set("violation", limit.violation)
                  .set("multiplier", limit.multiplier));
  }
  json.set("infeasible_constraints", list);
}

Json result_json(const Nlp& problem, const Measurement& measurement) {
  const Result& result = measurement.result;
  Json json = Json::object();
  json.set("schema", 1).set("problem", problem.name()).set("solver", measurement.solver).set("status", to_string(result.status));
  json.set("objective", result.objective).set("iterations", result.iterations).set("time_s", measurement.time);
  json.set("residual", residual_json(result.residual));
  if (result.scaled_residual) json.set("residual_scaled", residual_json(*result.scaled_residual));
  json.set("evaluations", evaluations_json(measurement.counts));
  json.set("x", measurement.point.x).set("lambda", measurement.point.lambda).set("z", measurement.point.z);
  if (result.status != Status::solved) set_explanation(json, problem, measurement);
  return json;
}

}  // namespace tenon
