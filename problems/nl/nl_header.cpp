#include "tenon/problems/nl/nl_header.hpp"

#include <numeric>
#include <string>

namespace tenon {

namespace {

constexpr int kMostOptions = 9;
constexpr int kMostCount = 1 << 28;  // sums of a line's counts stay within int
constexpr int kLittleEndian = 1;  // the kind of arithmetic, as the format numbers it; 0 says nothing
constexpr int kWithTolerance = 3;

/// One line of counts: at least `fewest`, at most `most` of them, those that are not there 0.
std::vector<int> read_counts(NlTokens& tokens, std::size_t fewest, std::size_t most, const char* what) {
  std::vector<int> counts;
  while (counts.size() < fewest || (counts.size() < most && tokens.has_word())) counts.push_back(tokens.integer(what, 0, kMostCount));
  tokens.end_line();
  counts.resize(most, 0);
  return counts;
}

/// Every count of this line must be 0: the program does not take such a thing.
void refuse(NlTokens& tokens, int count, const std::string& what) {
  if (count == 0) return;
  tokens.fail("the problem has " + what + " (" + std::to_string(count) + ")", "a problem with real variables and smooth rows");
}

/// The first line: `g3 1 1 0 # problem name`. Returns its letter.
char read_first_line(NlTokens& tokens, NlHeader& header) {
  const char letter = tokens.key("g or b, the kind of file");
  if (letter != 'g' && letter != 'b' && letter != 'z') {
    tokens.fail("this is no .nl file: it begins with " + shown(letter), "g for text, b for binary");
  }
  const int count = tokens.integer("the count of options", 0, kMostOptions);
  while (static_cast<int>(header.options.size()) < count && tokens.has_word()) {
    header.options.push_back(tokens.integer("an option", -(1 << 30), 1 << 30));
  }
  header.options.resize(static_cast<std::size_t>(count), 0);
  if (count > 1 && header.options[1] == kWithTolerance && tokens.has_word()) header.boundary_tolerance = tokens.number("a tolerance");
  tokens.end_line();
  return letter;
}

}  // namespace

NlHeader read_nl_header(NlTokens& tokens) {
  NlHeader header;
  const char letter = read_first_line(tokens, header);

  const std::vector<int> sizes = read_counts(tokens, 3, 6, "a count: variables, constraints, objectives, ranges, equations, logical");
  header.variables = sizes[0], header.constraints = sizes[1], header.objectives = sizes[2];
  refuse(tokens, sizes[5], "logical constraints");
  if (header.variables == 0) tokens.fail("the problem has no variable", "one or more");
  if (header.constraints + header.objectives == 0) tokens.fail("the problem has neither objective nor constraint", "one or more");

  const std::vector<int> nonlinear = read_counts(tokens, 2, 6, "a count: nonlinear constraints, objectives, complementarities");
  header.nonlinear_constraints = nonlinear[0], header.nonlinear_objectives = nonlinear[1];
  refuse(tokens, nonlinear[2] + nonlinear[3], "complementarity conditions");
  if (header.nonlinear_constraints > header.constraints || header.nonlinear_objectives > header.objectives) {
    tokens.fail("more nonlinear constraints or objectives than there are", "at most as many as the line before says");
  }
  read_counts(tokens, 2, 2, "a count: nonlinear network constraints, linear ones");

  const std::vector<int> variables = read_counts(tokens, 3, 3, "a count: nonlinear variables in constraints, objectives, both");
  header.variables_in_constraints = variables[0], header.variables_in_objectives = variables[1];
  if (header.nonlinear_variables() > header.variables || variables[2] > std::min(variables[0], variables[1])) {
    tokens.fail("more nonlinear variables than there are", "at most " + std::to_string(header.variables));
  }

  const std::vector<int> kinds = read_counts(tokens, 2, 4, "a count: network variables, functions; arithmetic, flags");
  refuse(tokens, kinds[1], "imported functions");
  if (kinds[2] > kLittleEndian) tokens.fail("numbers of another kind of machine", "0 or 1: IEEE arithmetic, little end first");

  const std::vector<int> discrete = read_counts(tokens, 5, 5, "a count: binary variables, integer ones, nonlinear ones (3)");
  refuse(tokens, std::accumulate(discrete.begin(), discrete.end(), 0), "integer variables");

  const std::vector<int> nonzeros = read_counts(tokens, 2, 2, "a count: non-zeros of the Jacobian, of gradients");
  header.jacobian_nonzeros = nonzeros[0], header.gradient_nonzeros = nonzeros[1];
  read_counts(tokens, 2, 2, "a length: the longest name of a constraint, of a variable");

  const std::vector<int> common = read_counts(tokens, 5, 5, "a count of common expressions (5)");
  header.common_expressions = std::accumulate(common.begin(), common.end(), 0);
  // Each of these takes a byte of the file or more: counts that lie are found before memory is asked for.
  for (const int count : {header.variables, header.constraints, header.objectives, header.jacobian_nonzeros, header.gradient_nonzeros,
                          header.common_expressions}) {
    if (static_cast<std::size_t>(count) > tokens.bytes_left()) {
      tokens.fail("the header counts more than the file can hold (" + std::to_string(count) + ")", "a file that is whole");
    }
  }
  if (letter != 'g') tokens.begin_binary(letter == 'z');
  return header;
}

}  // namespace tenon
