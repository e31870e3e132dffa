#include "tenon/problems/nl/nl_scan.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tenon/problems/nl/nl_expression.hpp"

namespace tenon {

namespace {

/// A row or an objective: what it refers to in its expression, and the variables of its linear part.
struct Function {
  bool is_read = false;
  NlReferences nonlinear;
  std::vector<int> linear;
};

class Scanner {
 public:
  Scanner(std::string_view bytes, const std::string& file)
      : bytes_(bytes),
        tokens_(bytes, file),
        head_(read_nl_header(tokens_)),
        rows_(size(head_.constraints)),
        objectives_(size(head_.objectives)),
        common_(size(head_.common_expressions)),
        visited_(size(head_.variables + head_.common_expressions), 0) {}

  NlScan scan() {
    while (!tokens_.at_end()) read_segment();
    check_complete();
    std::string bytes = bytes_for_library();
    return {std::move(head_), std::move(bytes)};
  }

 private:
  static std::size_t size(int count) { return static_cast<std::size_t>(count); }

  void read_segment() {
    const char key = tokens_.key("the key of a segment");
    switch (key) {
      case 'b': return once(has_bounds_, "b"), read_bounds(head_.variables, "of a variable");
      case 'r': return once(has_ranges_, "r"), read_bounds(head_.constraints, "of a row");
      case 'k': return once(has_columns_, "k"), read_columns(true);
      case 'K': return once(has_columns_, "k"), read_columns(false);
      case 'x': return once(has_start_, "x"), read_values(head_.variables, "variable");
      case 'd': return once(has_multipliers_, "d"), read_values(head_.constraints, "row");
      case 'C': return read_row();
      case 'O': return read_objective();
      case 'V': return read_common_expression();
      case 'J':
        if (!has_columns_) tokens_.fail("segment J stands before k", "the column counts first");
        return read_linear_part(rows_, "row");
      case 'G': return read_linear_part(objectives_, "objective");
      case 'S': return read_suffix();
      case 'F': tokens_.fail("an imported function", "a problem without imported functions");
      case 'L': tokens_.fail("a logical constraint", "a problem with real variables and smooth rows");
      default: tokens_.fail("no segment begins with " + shown(key), "one of C O V b r k x d J G S");
    }
  }

  void once(bool& seen, const char* segment) {
    if (seen) tokens_.fail(std::string("segment ") + segment + " stands twice", "it once");
    seen = true;
  }

  int read_index(const char* what, int count) {
    return tokens_.integer(what, 0, count - 1);
  }

  /// A lower bound (side 1), an upper one (-1) or both (0); beyond kNlNoBound it is none, but not on the wrong side.
  double read_bound(int side) {
    const double value = tokens_.number("a bound");
    if ((side >= 0 && value >= kNlNoBound) || (side <= 0 && value <= -kNlNoBound)) {
      tokens_.fail("nothing can meet a bound so far out", "a bound within 1e19, or none");
    }
    return value;
  }

  /// One line for each: 0 lower upper, 1 upper, 2 lower, 3 (free), 4 value.
  void read_bounds(int count, const std::string& of) {
    tokens_.end_line();
    for (int i = 0; i < count; ++i) {
      const char kind = tokens_.key("the kind of a bound, 0 to 4");
      switch (kind) {
        case '0': {
          const double lower = read_bound(1), upper = read_bound(-1);
          if (lower > upper) tokens_.fail("the lower bound " + of + " is above the upper one", "lower <= upper");
          break;
        }
        case '1': read_bound(-1); break;
        case '2': read_bound(1); break;
        case '3': break;
        case '4': read_bound(0); break;
        case '5': tokens_.fail("a complementarity condition", "a problem with real variables and smooth rows");
        default: tokens_.fail("a bound " + of + " begins with " + shown(kind), "its kind, 0 to 4");
      }
      tokens_.end_line();
    }
  }

  /// Non-zeros of all columns but the last, summed up (k) or each (K).
  void read_columns(bool summed) {
    tokens_.integer("the count of columns but one", head_.variables - 1, head_.variables - 1);
    tokens_.end_line();
    int before = 0;
    for (int j = 0; j + 1 < head_.variables; ++j) {
      const int value = tokens_.integer("a count of non-zeros", summed ? before : 0, head_.jacobian_nonzeros);
      tokens_.end_line();
      columns_.push_back(summed ? value - before : value);
      before = value;
    }
  }

  /// A count, then index and value.
  void read_values(int most, const char* what) {
    const int count = tokens_.integer("a count of values", 0, most);
    tokens_.end_line();
    for (int k = 0; k < count; ++k) {
      read_index(what, most);
      tokens_.number("a value");
      tokens_.end_line();
    }
  }

  void read_expression(Function& function, bool may_be_nonlinear, const char* what) {
    if (function.is_read) tokens_.fail(std::string(what) + " stands twice", "it once");
    function.is_read = true;
    function.nonlinear = read_expression(head_.variables + head_.common_expressions);
    if (!may_be_nonlinear && !function.nonlinear.is_constant) {
      tokens_.fail(std::string(what) + " is not among the nonlinear ones, which come first", "a number in place of this expression");
    }
  }

  void read_row() {
    const int row = read_index("a row", head_.constraints);
    tokens_.end_line();
    read_expression(rows_[size(row)], row < head_.nonlinear_constraints, "this row");
  }

  void read_objective() {
    const int objective = read_index("an objective", head_.objectives);
    tokens_.integer("0 to minimise or 1 to maximise", 0, 1);
    tokens_.end_line();
    read_expression(objectives_[size(objective)], objective < head_.nonlinear_objectives, "this objective");
  }

  NlReferences read_expression(int common_end) {
    NlReferences found = read_nl_expression(tokens_, {head_.nonlinear_variables(), head_.variables, common_end});
    lone_choices_.insert(lone_choices_.end(), found.lone_choices.begin(), found.lone_choices.end());
    return found;
  }

  /// The bytes of the file, with v + 0 for each lone choice v.
  std::string bytes_for_library() const {
    constexpr std::string_view kZeros("\0\0\0\0\0\0\0\0", sizeof(double));
    std::string plus = "o0\n", zero = "n0\n";
    if (tokens_.is_binary()) {
      plus = "o" + std::string(kZeros.substr(0, tokens_.has_short_operators() ? sizeof(std::int16_t) : sizeof(std::int32_t)));
      zero = "n" + std::string(kZeros);
    }
    std::string out;
    std::size_t done = 0;
    const auto copy_to = [&](std::size_t end) {
      out += bytes_.substr(done, end - done);
      done = end;
    };
    for (const NlRange& choice : lone_choices_) {
      copy_to(choice.begin);
      out += plus;
      copy_to(choice.end);
      out += zero;
    }
    copy_to(bytes_.size());
    return out;
  }

  /// Its linear part, then its expression; either may refer to what is numbered below it.
  void read_common_expression() {
    const int first = head_.variables;
    const int index = tokens_.integer("a common expression", first, first + head_.common_expressions - 1);
    const int terms = tokens_.integer("a count of linear terms", 0, head_.variables);
    tokens_.integer("where it is used", 0, head_.constraints + head_.objectives);
    tokens_.end_line();
    Function& common = common_[size(index - first)];
    for (int k = 0; k < terms; ++k) {
      common.linear.push_back(read_index("a nonlinear variable", head_.nonlinear_variables()));
      tokens_.number("a coefficient");
      tokens_.end_line();
    }
    if (common.is_read) tokens_.fail("this common expression stands twice", "it once");
    common.is_read = true;
    common.nonlinear = read_expression(index);
  }

  void read_linear_part(std::vector<Function>& functions, const char* what) {
    const int index = read_index(what, static_cast<int>(functions.size()));
    const int count = tokens_.integer("a count of linear terms", 1, head_.variables);
    tokens_.end_line();
    std::vector<int>& variables = functions[size(index)].linear;
    if (!variables.empty()) tokens_.fail(std::string("the linear terms of this ") + what + " stand twice", "them once");
    for (int k = 0; k < count; ++k) {
      variables.push_back(read_index("a variable", head_.variables));
      tokens_.number("a coefficient");
      tokens_.end_line();
    }
    std::sort(variables.begin(), variables.end());
    if (std::adjacent_find(variables.begin(), variables.end()) != variables.end()) {
      tokens_.fail(std::string("a variable has two linear terms in this ") + what, "one each");
    }
  }

  /// Of variables, rows, objectives or the problem; whole numbers, or real ones where bit 4 is set. What it says is not used.
  void read_suffix() {
    const int kind = tokens_.integer("the kind of a suffix", 0, 7);
    const int counts[] = {head_.variables, head_.constraints, head_.objectives, 1};
    const int most = counts[kind & 3];
    const int count = tokens_.integer("a count of values", 1, most);
    tokens_.name("the name of a suffix");
    tokens_.end_line();
    for (int k = 0; k < count; ++k) {
      read_index("an index", most);
      if ((kind & 4) != 0)
        tokens_.number("a value");
      else
        tokens_.integer("a value", -2147483647 - 1, 2147483647);
      tokens_.end_line();
    }
  }

  void check_complete() {
    const auto need = [&](bool is_there, const std::string& what) {
      if (!is_there) tokens_.fail("the file ends without " + what, "a file that is whole");
    };
    need(has_bounds_, "the bounds of the variables, segment b");
    need(has_ranges_ || head_.constraints == 0, "the ranges of the rows, segment r");
    const auto need_all = [&](const std::vector<Function>& functions, const std::string& what, int first) {
      for (std::size_t k = 0; k < functions.size(); ++k) need(functions[k].is_read, what + std::to_string(first + static_cast<int>(k)));
    };
    need_all(common_, "common expression V", head_.variables);
    need_all(rows_, "row C", 0);
    need_all(objectives_, "objective O", 0);
    check_counts();
    check_linear_parts(rows_, "row C");
    check_linear_parts(objectives_, "objective O");
  }

  void check_counts() {
    std::vector<int> columns(size(head_.variables), 0);
    int jacobian = 0, gradient = 0;
    for (const Function& row : rows_) {
      for (const int j : row.linear) ++columns[size(j)], ++jacobian;
    }
    for (const Function& objective : objectives_) gradient += static_cast<int>(objective.linear.size());
    const auto compare = [&](int found, int said, const char* what) {
      if (found == said) return;
      tokens_.fail("there are " + std::to_string(found) + " non-zeros of the " + what, std::to_string(said) + ", as the head says");
    };
    compare(jacobian, head_.jacobian_nonzeros, "Jacobian");
    compare(gradient, head_.gradient_nonzeros, "gradients");
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      if (columns[j] != columns_[j]) {
        tokens_.fail("column " + std::to_string(j) + " of the Jacobian has " + std::to_string(columns[j]) + " non-zeros",
                     std::to_string(columns_[j]) + ", as segment k says");
      }
    }
  }

  /// Every variable of an expression, those of its common expressions included, has a linear term, be it 0: derivatives go there.
  void check_linear_parts(const std::vector<Function>& functions, const char* what) {
    std::vector<int> open;
    for (std::size_t f = 0; f < functions.size(); ++f) {
      ++visit_;
      for (const int j : functions[f].linear) visited_[size(j)] = visit_;
      open = functions[f].nonlinear.indices;
      while (!open.empty()) {
        const int index = open.back();
        open.pop_back();
        int& seen = visited_[size(index)];
        if (seen == visit_) continue;
        if (index < head_.variables) {
          tokens_.fail("variable " + std::to_string(index) + " has no linear term in " + what + std::to_string(f),
                       "one, be it 0, for every variable of its expression");
        }
        seen = visit_;
        const Function& common = common_[size(index - head_.variables)];
        open.insert(open.end(), common.linear.begin(), common.linear.end());
        open.insert(open.end(), common.nonlinear.indices.begin(), common.nonlinear.indices.end());
      }
    }
  }

  std::string_view bytes_;
  NlTokens tokens_;
  NlHeader head_;
  std::vector<Function> rows_, objectives_, common_;
  std::vector<NlRange> lone_choices_;
  std::vector<int> columns_;  // non-zeros of each but the last, as segment k has them
  bool has_bounds_ = false, has_ranges_ = false, has_columns_ = false, has_start_ = false, has_multipliers_ = false;
  std::vector<int> visited_;  // by index: the last visit that came by
  int visit_ = 0;
};

}  // namespace

NlScan scan_nl(std::string_view bytes, const std::string& file) {
  return Scanner(bytes, file).scan();
}

}  // namespace tenon
