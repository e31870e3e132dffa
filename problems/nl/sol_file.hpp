// The .sol file with which a solver answers AMPL: message, the options of the .nl file again, multipliers, variables, a code.
// Source: D. M. Gay, Hooking Your Solver to AMPL, Bell Laboratories report 97-4-06.
#pragma once

#include <string>

#include "tenon/core/status.hpp"
#include "tenon/problems/nl/nl_file.hpp"

namespace tenon {

/// AMPL's solve_result_num: hundreds say solved, uncertain, infeasible, unbounded, limit, failure.
int ampl_code(Status status);

/// The text of the file. `message` is one line; `point` is in our sign, AMPL's multiplier of a row is the rate of the best objective
/// with the row's bound: -lambda where the file minimises, +lambda where it maximises.
std::string sol_text(const NlFile& file, const Point& point, Status status, const std::string& message);

}  // namespace tenon
