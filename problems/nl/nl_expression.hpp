// An expression of a .nl file, in prefix form: walked to its end, checked, and reduced to what it refers to.
//
//     expression = n NUMBER | v INDEX | o OPERATOR operands...
//
// Index n and above are common expressions (segment V), each of which may refer to those before it.
#pragma once

#include <vector>

#include "tenon/problems/nl/nl_operators.hpp"
#include "tenon/problems/nl/nl_tokens.hpp"

namespace tenon {

/// Which references an expression may hold.
struct NlScope {
  int nonlinear_variables = 0;     // v0 .. : the file has these first
  int variables = 0;               // n
  int common_begin = 0;            // n: index of the first common expression
  int common_end = 0;              // past the last one that is there already
};

struct NlReferences {
  bool is_constant = false;  // a mere number
  std::vector<int> indices;  // of variables and common expressions, ascending, each once
};

/// Reads one expression whose value is a number. Throws InputError.
NlReferences read_nl_expression(NlTokens& tokens, const NlScope& scope);

}  // namespace tenon
