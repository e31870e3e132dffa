// The result of a solve as INTERFACES has it: the fields that `solve --json` and `compare --json` share.
#pragma once

#include "tenon/apps/json.hpp"
#include "tenon/apps/measure.hpp"

namespace tenon {

Json residual_json(const KktResidual& residual);
Json evaluations_json(const EvaluationCounts& counts);

/// The field `explanation` of an end that is not `solved`, and of an infeasible one `infeasible_constraints`: what cannot be met together.
void set_explanation(Json& json, const Nlp& problem, const Measurement& measurement);

/// schema, problem, solver, status, objective, iterations, time_s, residual, residual_scaled where the solver scaled, evaluations, x,
/// lambda, z, and the explanation.
Json result_json(const Nlp& problem, const Measurement& measurement);

}  // namespace tenon
