// The operators of .nl expressions: number, name, how many operands, and whether those and the result are numbers or truth values.
// Source: D. M. Gay, Hooking Your Solver to AMPL, appendix; the numbers are those of the solver library's header opcode.hd.
#pragma once

#include <array>

namespace tenon {

enum class NlKind { number, truth };

/// What follows an operator in the file.
enum class NlShape {
  unknown,    // no such operator
  refused,    // there is one, and it is none of a smooth program's
  unary,      // one operand
  binary,     // two
  list,       // their count, then they
  choice,     // a truth value, then two numbers
  piecewise,  // the count of slopes, slopes and breakpoints by turns, a variable
};

struct NlOperator {
  const char* name = "";
  NlShape shape = NlShape::unknown;
  NlKind operand = NlKind::number;
  NlKind result = NlKind::number;
  int fewest = 0;        // operands of a list
  bool branches = false; // its value is one of its operands
};

inline constexpr int kNlOperators = 76;

/// By number.
constexpr std::array<NlOperator, kNlOperators> nl_operators() {
  using enum NlShape;
  constexpr NlKind number = NlKind::number, truth = NlKind::truth;
  std::array<NlOperator, kNlOperators> table{};
  table[0] = {"+", binary};
  table[1] = {"-", binary};
  table[2] = {"*", binary};
  table[3] = {"/", binary};
  table[4] = {"mod", binary};
  table[5] = {"^", binary};
  table[6] = {"less", binary};
  table[11] = {"min", list, number, number, 1, true};
  table[12] = {"max", list, number, number, 1, true};
  table[13] = {"floor", unary};
  table[14] = {"ceil", unary};
  table[15] = {"abs", unary};
  table[16] = {"unary -", unary};
  table[20] = {"or", binary, truth, truth};
  table[21] = {"and", binary, truth, truth};
  table[22] = {"<", binary, number, truth};
  table[23] = {"<=", binary, number, truth};
  table[24] = {"=", binary, number, truth};
  table[28] = {">=", binary, number, truth};
  table[29] = {">", binary, number, truth};
  table[30] = {"!=", binary, number, truth};
  table[34] = {"not", unary, truth, truth};
  table[35] = {"if", choice, number, number, 0, true};
  table[37] = {"tanh", unary};
  table[38] = {"tan", unary};
  table[39] = {"sqrt", unary};
  table[40] = {"sinh", unary};
  table[41] = {"sin", unary};
  table[42] = {"log10", unary};
  table[43] = {"log", unary};
  table[44] = {"exp", unary};
  table[45] = {"cosh", unary};
  table[46] = {"cos", unary};
  table[47] = {"atanh", unary};
  table[48] = {"atan2", binary};
  table[49] = {"atan", unary};
  table[50] = {"asinh", unary};
  table[51] = {"asin", unary};
  table[52] = {"acosh", unary};
  table[53] = {"acos", unary};
  table[54] = {"sum", list, number, number, 3};
  table[55] = {"div", refused};
  table[56] = {"precision", refused};
  table[57] = {"round", refused};
  table[58] = {"trunc", refused};
  table[59] = {"count", refused};
  table[60] = {"numberof", refused};
  table[61] = {"numberof of symbols", refused};
  table[62] = {"at least", refused};
  table[63] = {"at most", refused};
  table[64] = {"piecewise linear", piecewise};
  table[65] = {"if of symbols", refused};
  table[66] = {"exactly", refused};
  table[67] = {"not at least", refused};
  table[68] = {"not at most", refused};
  table[69] = {"not exactly", refused};
  table[70] = {"forall", list, truth, truth, 3};
  table[71] = {"exists", list, truth, truth, 3};
  table[72] = {"implies", refused};
  table[73] = {"iff", binary, truth, truth};
  table[74] = {"alldiff", refused};
  table[75] = {"not alldiff", refused};
  return table;
}

}  // namespace tenon
