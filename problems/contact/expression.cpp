#include "tenon/problems/contact/expression.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"

namespace tenon::contact {

namespace {

using Op = Expression::Op;

struct Function {
  Op op;
  int arguments;
};

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> table{
      {"sin", {Op::sine, 1}},         {"cos", {Op::cosine, 1}},    {"tan", {Op::tangent, 1}},   {"sqrt", {Op::root, 1}},
      {"exp", {Op::exponential, 1}},  {"log", {Op::logarithm, 1}}, {"abs", {Op::magnitude, 1}}, {"tanh", {Op::hyperbolic_tangent, 1}},
      {"atan", {Op::arc_tangent, 1}}, {"floor", {Op::floor, 1}},   {"min", {Op::minimum, 2}},   {"max", {Op::maximum, 2}},
      {"if", {Op::choose, 3}},
  };
  return table;
}

/// Recursive descent: comparison < sum < product < power < sign < atom.
class Parser {
 public:
  Parser(const std::string& text, const std::vector<std::string>& variables) : text_(text), variables_(variables) {}

  std::vector<Expression::Step> parse() {
    comparison();
    skip_blanks();
    if (at_ < text_.size()) fail("'" + text_.substr(at_) + "' is not understood");
    return std::move(steps_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw std::invalid_argument("expression '" + text_ + "': " + what); }

  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void push(Expression::Step step, int consumed) {
    depth_ += 1 - consumed;
    if (depth_ > kMostOperands) fail("it is too deep");
    steps_.push_back(step);
  }

  void comparison() {
    sum();
    if (take('<')) {
      sum();
      push({Op::less}, 2);
    } else if (take('>')) {
      sum();
      push({Op::greater}, 2);
    }
  }
  void sum() {
    product();
    for (;;) {
      if (take('+'))
        product(), push({Op::add}, 2);
      else if (take('-'))
        product(), push({Op::subtract}, 2);
      else
        return;
    }
  }
  void product() {
    sign();
    for (;;) {
      if (take('*'))
        sign(), push({Op::multiply}, 2);
      else if (take('/'))
        sign(), push({Op::divide}, 2);
      else
        return;
    }
  }
  void sign() {
    if (take('-'))
      sign(), push({Op::negate}, 1);
    else
      power();
  }
  void power() {
    atom();
    if (take('^')) sign(), push({Op::power}, 2);
  }
  void atom() {
    skip_blanks();
    if (at_ >= text_.size()) fail("something is missing at its end");
    if (take('(')) {
      comparison();
      if (!take(')')) fail("a ')' is missing");
      return;
    }
    const char c = text_[at_];
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') return name();
    fail("'" + text_.substr(at_) + "' is not understood");
  }
  void number() {
    char* end = nullptr;
    const double value = std::strtod(text_.c_str() + at_, &end);
    at_ = static_cast<std::size_t>(end - text_.c_str());
    push({Op::constant, value}, 0);
  }
  void name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    const std::string word = text_.substr(begin, at_ - begin);
    if (const auto variable = std::find(variables_.begin(), variables_.end(), word); variable != variables_.end())
      return push({Op::variable, 0, static_cast<int>(variable - variables_.begin())}, 0);
    if (word == "pi") return push({Op::constant, std::numbers::pi}, 0);
    const auto function = functions().find(word);
    if (function == functions().end()) {
      std::vector<std::string> known = variables_;
      known.emplace_back("pi");
      for (const auto& [known_name, f] : functions()) known.push_back(known_name);
      fail("'" + word + "' is not known, the nearest is '" + nearest_name(word, known) + "'");
    }
    if (!take('(')) fail("a '(' is missing after " + word);
    for (int k = 0; k < function->second.arguments; ++k) {
      if (k > 0 && !take(',')) fail(word + " takes " + std::to_string(function->second.arguments) + " arguments");
      comparison();
    }
    if (!take(')')) fail("a ')' is missing after the arguments of " + word);
    push({function->second.op}, function->second.arguments);
  }

  const std::string& text_;
  const std::vector<std::string>& variables_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Expression::Step> steps_;
};

}  // namespace

Expression::Expression(const std::string& text, const std::vector<std::string>& variables) : steps_(Parser(text, variables).parse()) {}

}  // namespace tenon::contact
