#include "tenon/problems/nl/nl_expression.hpp"

#include <algorithm>
#include <string>

namespace tenon {

namespace {

/// The library walks expressions recursively; its frames for so many levels fit in a stack of 8 MB many times over.
constexpr std::size_t kDeepest = 5000;

constexpr std::array<NlOperator, kNlOperators> kOperators = nl_operators();

/// Operands that an operator still waits for.
struct Pending {
  const NlOperator* of;
  int left;
  bool is_choice;             // of an operator that branches
  bool has_variable = false;  // in the operands so far
};

/// What follows the key of a constant. Short ones save room in binary files.
double read_constant(NlTokens& tokens, char key) {
  double value = 0;
  if (key == 'n')
    value = tokens.number("a number");
  else if (key == 's' && tokens.is_binary())
    value = tokens.short_integer("a short integer", -32768, 32767);
  else if (key == 'l' && tokens.is_binary())
    value = tokens.integer("an integer", -2147483647 - 1, 2147483647);
  else
    tokens.fail("found " + shown(key), "a number: n, or in binary s or l");
  tokens.end_line();
  return value;
}

class Reader {
 public:
  Reader(NlTokens& tokens, const NlScope& scope) : tokens_(tokens), scope_(scope) {}

  NlReferences read() {
    do {
      read_node();
      while (!pending_.empty() && pending_.back().left == 0) close();
    } while (!pending_.empty());
    std::sort(found_.indices.begin(), found_.indices.end());
    found_.indices.erase(std::unique(found_.indices.begin(), found_.indices.end()), found_.indices.end());
    return std::move(found_);
  }

 private:
  /// What the next operand is to be; takes it off the count.
  NlKind next_kind() {
    is_choice_ = false;
    if (pending_.empty()) return NlKind::number;
    Pending& waiting = pending_.back();
    const bool is_condition = waiting.of->shape == NlShape::choice && waiting.left == 3;
    --waiting.left;
    is_choice_ = waiting.of->branches && !is_condition;
    return is_condition ? NlKind::truth : waiting.of->operand;
  }

  /// The innermost operator has all its operands.
  void close() {
    const Pending closed = pending_.back();
    pending_.pop_back();
    if (closed.is_choice && !closed.has_variable) {
      tokens_.fail("a constant expression as a choice of min, max or if", "a number in its place");
    }
    if (!pending_.empty() && closed.has_variable) pending_.back().has_variable = true;
  }

  void read_node() {
    const bool is_whole = pending_.empty();
    const std::size_t begin = tokens_.offset();
    const NlKind wanted = next_kind();
    const char key = tokens_.key("an expression: n, v or o");
    switch (key) {
      case 'n':
      case 's':
      case 'l':
        read_constant(tokens_, key);
        found_.is_constant = is_whole;
        return;
      case 'v':
        read_variable(wanted);
        if (is_choice_) found_.lone_choices.push_back({begin, tokens_.offset()});
        return;
      case 'o': return read_operator(wanted);
      case 'f': tokens_.fail("an imported function is called", "a problem without imported functions");
      case 'h': tokens_.fail("a string", "an expression of numbers");
      default: tokens_.fail("found " + shown(key), "an expression: n, v or o");
    }
  }

  void read_variable(NlKind wanted) {
    if (wanted == NlKind::truth) tokens_.fail("a variable where a condition should stand", "a comparison");
    const int index = tokens_.integer("a variable or common expression that is there already", 0, scope_.common_end - 1);
    if (index < scope_.variables && index >= scope_.nonlinear_variables) {
      tokens_.fail("variable " + std::to_string(index) + " stands in an expression",
                   "one of the " + std::to_string(scope_.nonlinear_variables) + " nonlinear ones that the header counts");
    }
    tokens_.end_line();
    found_.indices.push_back(index);
    if (!pending_.empty()) pending_.back().has_variable = true;
  }

  void read_operator(NlKind wanted) {
    const int code = tokens_.operator_code(kNlOperators - 1);
    const NlOperator& op = kOperators[static_cast<std::size_t>(code)];
    if (op.shape == NlShape::unknown) tokens_.fail("there is no operator " + std::to_string(code), "one of AMPL's");
    if (op.shape == NlShape::refused) {
      tokens_.fail("the operator '" + std::string(op.name) + "' is not taken", "a smooth program: arithmetic, functions, if, min and max");
    }
    if (op.result != wanted) {
      tokens_.fail("the operator '" + std::string(op.name) + "' stands here",
                   wanted == NlKind::truth ? "a comparison or logical operator" : "an operator whose value is a number");
    }
    tokens_.end_line();
    if (pending_.size() >= kDeepest) tokens_.fail("the expression is nested too deeply", "at most " + std::to_string(kDeepest) + " levels");
    switch (op.shape) {
      case NlShape::unary: return push(op, 1);
      case NlShape::binary: return push(op, 2);
      case NlShape::choice: return push(op, 3);
      case NlShape::list: return push(op, read_count(op.fewest));
      default: return read_piecewise();
    }
  }

  void push(const NlOperator& op, int operands) { pending_.push_back({&op, operands, is_choice_}); }

  int read_count(int fewest) {
    const int most = static_cast<int>(std::min<std::size_t>(tokens_.bytes_left(), 1u << 30));  // each takes a byte or more
    const int count = tokens_.integer("the count of operands", fewest, most);
    tokens_.end_line();
    return count;
  }

  /// Slopes and breakpoints by turns, a slope first and last, then the variable.
  void read_piecewise() {
    const int slopes = read_count(2);
    double last_breakpoint = 0;
    for (int k = 0; k < 2 * slopes - 1; ++k) {
      const double value = read_constant(tokens_, tokens_.key("a slope or breakpoint"));
      if (k % 2 == 0) continue;
      if (k > 1 && value <= last_breakpoint) tokens_.fail("the breakpoints do not rise", "each greater than the one before");
      last_breakpoint = value;
    }
    constexpr const char* kVariable = "the variable of a piecewise linear term";
    if (tokens_.key(kVariable) != 'v') tokens_.fail("no variable", kVariable);
    read_variable(NlKind::number);
    if (found_.indices.back() >= scope_.variables) {
      tokens_.fail("a piecewise linear term of a common expression", "of a variable: the library's derivative is wrong elsewhere");
    }
  }

  NlTokens& tokens_;
  const NlScope& scope_;
  std::vector<Pending> pending_;
  bool is_choice_ = false;  // the node that is read now
  NlReferences found_;
};

}  // namespace

NlReferences read_nl_expression(NlTokens& tokens, const NlScope& scope) {
  return Reader(tokens, scope).read();
}

}  // namespace tenon
