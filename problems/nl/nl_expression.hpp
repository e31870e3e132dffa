// An expression of a .nl file, in prefix form: walked to its end, checked, and reduced to what it refers to.
//
//     expression = n NUMBER | v INDEX | o OPERATOR operands...
//
// Index n and above are common expressions (segment V), each of which may refer to those before it.
//
// What min, max and if choose from must be a number, or depend on a variable; and the library's Hessian forgets a variable that stands
// there alone, so such places are noted, to be handed over as v + 0.
#pragma once

#include <cstddef>
#include <vector>

#include "tenon/problems/nl/nl_operators.hpp"
#include "tenon/problems/nl/nl_tokens.hpp"

namespace tenon {

/// Which references an expression may hold.
struct NlScope {
  int nonlinear_variables = 0;  // the file has these first
  int variables = 0;            // n; indices from here on are common expressions
  int common_end = 0;           // past the last one that may be referred to
};

/// Bytes of the file.
struct NlRange {
  std::size_t begin, end;
};

struct NlReferences {
  std::vector<NlRange> lone_choices;  // variables that stand alone as a choice of min, max or if
  bool is_constant = false;  // a mere number
  std::vector<int> indices;  // of variables and common expressions, ascending, each once
};

/// Reads one expression whose value is a number. Throws InputError.
NlReferences read_nl_expression(NlTokens& tokens, const NlScope& scope);

}  // namespace tenon
