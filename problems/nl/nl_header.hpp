// The ten lines at the head of a .nl file: what it holds, in counts.
#pragma once

#include <algorithm>
#include <vector>

#include "tenon/problems/nl/nl_tokens.hpp"

namespace tenon {

struct NlHeader {
  std::vector<int> options;  // of the first line: AMPL wants them back in the .sol file
  double boundary_tolerance = 0;  // likewise, where options[1] is 3

  int variables = 0;    // n
  int constraints = 0;  // m
  int objectives = 0;
  int nonlinear_constraints = 0, nonlinear_objectives = 0;                   // they come first
  int variables_in_constraints = 0, variables_in_objectives = 0;             // nonlinear ones; they come first as well
  int jacobian_nonzeros = 0, gradient_nonzeros = 0;
  int common_expressions = 0;

  int nonlinear_variables() const { return std::max(variables_in_constraints, variables_in_objectives); }
};

/// Leaves the tokens after the head, in binary where it says so. Throws InputError, also for what this program does not take: integer
/// variables, complementarity, logical constraints, imported functions, and a problem with nothing to solve.
NlHeader read_nl_header(NlTokens& tokens);

}  // namespace tenon
