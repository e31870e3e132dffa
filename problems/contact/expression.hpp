// A small arithmetic expression in named variables: "20 * sin(2*pi*t) - 3*vx".
//
//     + - * / ^ ( )   sin cos tan sqrt exp log abs tanh atan floor min(a, b) max(a, b) if(c, a, b): a where c > 0   < > comparisons give 0
//     or 1   pi
//
// Compiled once to a stack program; evaluated on any scalar type, so that one that carries derivatives gives exact ones.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace tenon::contact {

class Expression {
 public:
  enum class Op {
    constant,
    variable,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    less,
    greater,
    sine,
    cosine,
    tangent,
    root,
    exponential,
    logarithm,
    magnitude,
    hyperbolic_tangent,
    arc_tangent,
    floor,
    minimum,
    maximum,
    choose
  };
  struct Step {
    Op op;
    double value = 0;  // of a constant
    int index = 0;     // of a variable
  };

  Expression() = default;
  /// Throws std::invalid_argument, saying what was not understood; variables are known by their place in the list.
  Expression(const std::string& text, const std::vector<std::string>& variables);

  bool empty() const { return steps_.empty(); }

  template <class S>
  S evaluate(std::span<const S> variables) const;

 private:
  std::vector<Step> steps_;
};

inline constexpr int kMostOperands = 32;  // on the stack at once; the parser refuses what needs more

namespace detail {
inline double value_of(double x) {
  return x;
}
template <class S>
double value_of(const S& x) {
  return x.value();
}
}  // namespace detail

template <class S>
S Expression::evaluate(std::span<const S> variables) const {
  using std::sin, std::cos, std::tan, std::sqrt, std::exp, std::log, std::abs, std::tanh, std::atan2, std::pow;
  S stack[kMostOperands];
  int top = -1;
  for (const Step& step : steps_) {
    switch (step.op) {
      case Op::constant:
        stack[++top] = S(step.value);
        break;
      case Op::variable:
        stack[++top] = variables[static_cast<std::size_t>(step.index)];
        break;
      case Op::add:
        --top, stack[top] = S(stack[top] + stack[top + 1]);
        break;
      case Op::subtract:
        --top, stack[top] = S(stack[top] - stack[top + 1]);
        break;
      case Op::multiply:
        --top, stack[top] = S(stack[top] * stack[top + 1]);
        break;
      case Op::divide:
        --top, stack[top] = S(stack[top] / stack[top + 1]);
        break;
      case Op::power:
        --top, stack[top] = S(pow(stack[top], detail::value_of(stack[top + 1])));
        break;
      case Op::negate:
        stack[top] = S(-stack[top]);
        break;
      case Op::less:
        --top, stack[top] = S(detail::value_of(stack[top]) < detail::value_of(stack[top + 1]) ? 1 : 0);
        break;
      case Op::greater:
        --top, stack[top] = S(detail::value_of(stack[top]) > detail::value_of(stack[top + 1]) ? 1 : 0);
        break;
      case Op::sine:
        stack[top] = S(sin(stack[top]));
        break;
      case Op::cosine:
        stack[top] = S(cos(stack[top]));
        break;
      case Op::tangent:
        stack[top] = S(tan(stack[top]));
        break;
      case Op::root:
        stack[top] = S(sqrt(stack[top]));
        break;
      case Op::exponential:
        stack[top] = S(exp(stack[top]));
        break;
      case Op::logarithm:
        stack[top] = S(log(stack[top]));
        break;
      case Op::magnitude:
        stack[top] = S(abs(stack[top]));
        break;
      case Op::hyperbolic_tangent:
        stack[top] = S(tanh(stack[top]));
        break;
      case Op::arc_tangent:
        stack[top] = S(atan2(stack[top], S(1)));
        break;
      case Op::floor:
        stack[top] = S(std::floor(detail::value_of(stack[top])));
        break;
      case Op::minimum:
        --top, stack[top] = detail::value_of(stack[top + 1]) < detail::value_of(stack[top]) ? stack[top + 1] : stack[top];
        break;
      case Op::maximum:
        --top, stack[top] = detail::value_of(stack[top + 1]) > detail::value_of(stack[top]) ? stack[top + 1] : stack[top];
        break;
      case Op::choose:
        top -= 2, stack[top] = detail::value_of(stack[top]) > 0 ? stack[top + 1] : stack[top + 2];
        break;
    }
  }
  return stack[0];
}

}  // namespace tenon::contact
