// The problems as the collection states them: g(x) >= 0 or h(x) = 0, starting point, bounds, optimum. One function each, and the
// collection's numbering of the variables: x1 is the first.
#include "tenon/problems/classic/hock_schittkowski.hpp"

#include "tenon/problems/classic/polynomial.hpp"

namespace tenon {

namespace {

/// The variables under the collection's names: x(1) .. x(n).
class Variables {
 public:
  explicit Variables(int n) : x_(polynomial_variables(n)) {}
  const Polynomial& operator()(int i) const { return x_[static_cast<std::size_t>(i) - 1]; }

 private:
  std::vector<Polynomial> x_;
};

Vector values(std::initializer_list<double> list) { return Eigen::Map<const Vector>(list.begin(), static_cast<Eigen::Index>(list.size())); }

constexpr double kNone = kInfinity<double>;

PolynomialProgram hs001() {
  const Variables x(2);
  return {.start = values({-2, 1}),
          .x_lower = values({-kNone, -1.5}),
          .objective = 100 * square(x(2) - square(x(1))) + square(1 - x(1))};
}

PolynomialProgram hs006() {
  const Variables x(2);
  return {.start = values({-1.2, 1}),
          .objective = square(1 - x(1)),
          .rows = {equals_zero(10 * (x(2) - square(x(1))))}};
}

PolynomialProgram hs012() {
  const Variables x(2);
  return {.start = values({0, 0}),
          .objective = 0.5 * square(x(1)) + square(x(2)) - x(1) * x(2) - 7 * x(1) - 7 * x(2),
          .rows = {at_least_zero(25 - 4 * square(x(1)) - square(x(2)))}};
}

PolynomialProgram hs021() {
  const Variables x(2);
  return {.start = values({-1, -1}),
          .x_lower = values({2, -50}),
          .x_upper = values({50, 50}),
          .objective = 0.01 * square(x(1)) + square(x(2)) - 100,
          .rows = {at_least_zero(10 * x(1) - x(2) - 10)}};
}

PolynomialProgram hs028() {
  const Variables x(3);
  return {.start = values({-4, 1, 1}),
          .objective = square(x(1) + x(2)) + square(x(2) + x(3)),
          .rows = {equals_zero(x(1) + 2 * x(2) + 3 * x(3) - 1)}};
}

PolynomialProgram hs035() {
  const Variables x(3);
  return {.start = values({0.5, 0.5, 0.5}),
          .x_lower = Vector::Zero(3),
          .objective = 9 - 8 * x(1) - 6 * x(2) - 4 * x(3) + 2 * square(x(1)) + 2 * square(x(2)) + square(x(3)) + 2 * x(1) * x(2) +
                       2 * x(1) * x(3),
          .rows = {at_least_zero(3 - x(1) - x(2) - 2 * x(3))}};
}

PolynomialProgram hs039() {
  const Variables x(4);
  return {.start = values({2, 2, 2, 2}),
          .objective = -x(1),
          .rows = {equals_zero(x(2) - power(x(1), 3) - square(x(3))), equals_zero(square(x(1)) - x(2) - square(x(4)))}};
}

PolynomialProgram hs040() {
  const Variables x(4);
  return {.start = values({0.8, 0.8, 0.8, 0.8}),
          .objective = -x(1) * x(2) * x(3) * x(4),
          .rows = {equals_zero(power(x(1), 3) + square(x(2)) - 1), equals_zero(square(x(1)) * x(4) - x(3)),
                   equals_zero(square(x(4)) - x(2))}};
}

PolynomialProgram hs043() {
  const Variables x(4);
  return {.start = values({0, 0, 0, 0}),
          .objective = square(x(1)) + square(x(2)) + 2 * square(x(3)) + square(x(4)) - 5 * x(1) - 5 * x(2) - 21 * x(3) + 7 * x(4),
          .rows = {at_least_zero(8 - square(x(1)) - square(x(2)) - square(x(3)) - square(x(4)) - x(1) + x(2) - x(3) + x(4)),
                   at_least_zero(10 - square(x(1)) - 2 * square(x(2)) - square(x(3)) - 2 * square(x(4)) + x(1) + x(4)),
                   at_least_zero(5 - 2 * square(x(1)) - square(x(2)) - square(x(3)) - 2 * x(1) + x(2) + x(4))}};
}

PolynomialProgram hs044() {
  const Variables x(4);
  return {.start = values({0, 0, 0, 0}),
          .x_lower = Vector::Zero(4),
          .objective = x(1) - x(2) - x(3) - x(1) * x(3) + x(1) * x(4) + x(2) * x(3) - x(2) * x(4),
          .rows = {at_least_zero(8 - x(1) - 2 * x(2)), at_least_zero(12 - 4 * x(1) - x(2)), at_least_zero(12 - 3 * x(1) - 4 * x(2)),
                   at_least_zero(8 - 2 * x(3) - x(4)), at_least_zero(8 - x(3) - 2 * x(4)), at_least_zero(5 - x(3) - x(4))}};
}

PolynomialProgram hs065() {
  const Variables x(3);
  return {.start = values({-5, 5, 0}),
          .x_lower = values({-4.5, -4.5, -5}),
          .x_upper = values({4.5, 4.5, 5}),
          .objective = square(x(1) - x(2)) + 1.0 / 9 * square(x(1) + x(2) - 10) + square(x(3) - 5),
          .rows = {at_least_zero(48 - square(x(1)) - square(x(2)) - square(x(3)))}};
}

PolynomialProgram hs071() {
  const Variables x(4);
  return {.start = values({1, 5, 5, 1}),
          .x_lower = Vector::Constant(4, 1),
          .x_upper = Vector::Constant(4, 5),
          .objective = x(1) * x(4) * (x(1) + x(2) + x(3)) + x(3),
          .rows = {at_least_zero(x(1) * x(2) * x(3) * x(4) - 25),
                   equals_zero(square(x(1)) + square(x(2)) + square(x(3)) + square(x(4)) - 40)}};
}

PolynomialProgram hs076() {
  const Variables x(4);
  return {.start = values({0.5, 0.5, 0.5, 0.5}),
          .x_lower = Vector::Zero(4),
          .objective = square(x(1)) + 0.5 * square(x(2)) + square(x(3)) + 0.5 * square(x(4)) - x(1) * x(3) + x(3) * x(4) - x(1) -
                       3 * x(2) + x(3) - x(4),
          .rows = {at_least_zero(5 - x(1) - 2 * x(2) - x(3) - x(4)), at_least_zero(4 - 3 * x(1) - x(2) - 2 * x(3) + x(4)),
                   at_least_zero(x(2) + 4 * x(3) - 1.5)}};
}

PolynomialProgram hs093() {
  const Variables x(6);
  const Polynomial a = x(1) + x(2) + x(3), b = x(1) + 1.57 * x(2) + x(4);
  return {.start = values({5.54, 4.4, 12.02, 11.82, 0.702, 0.852}),
          .x_lower = Vector::Zero(6),
          .objective = 0.0204 * x(1) * x(4) * a + 0.0187 * x(2) * x(3) * b + 0.0607 * x(1) * x(4) * square(x(5)) * a +
                       0.0437 * x(2) * x(3) * square(x(6)) * b,
          .rows = {at_least_zero(0.001 * x(1) * x(2) * x(3) * x(4) * x(5) * x(6) - 2.07),
                   at_least_zero(1 - 0.00062 * x(1) * x(4) * square(x(5)) * a - 0.00058 * x(2) * x(3) * square(x(6)) * b)}};
}

PolynomialProgram hs100() {
  const Variables x(7);
  return {.start = values({1, 2, 0, 4, 0, 1, 1}),
          .objective = square(x(1) - 10) + 5 * square(x(2) - 12) + power(x(3), 4) + 3 * square(x(4) - 11) + 10 * power(x(5), 6) +
                       7 * square(x(6)) + power(x(7), 4) - 4 * x(6) * x(7) - 10 * x(6) - 8 * x(7),
          .rows = {at_least_zero(127 - 2 * square(x(1)) - 3 * power(x(2), 4) - x(3) - 4 * square(x(4)) - 5 * x(5)),
                   at_least_zero(282 - 7 * x(1) - 3 * x(2) - 10 * square(x(3)) - x(4) + x(5)),
                   at_least_zero(196 - 23 * x(1) - square(x(2)) - 6 * square(x(6)) + 8 * x(7)),
                   at_least_zero(-4 * square(x(1)) - square(x(2)) + 3 * x(1) * x(2) - 2 * square(x(3)) - 5 * x(6) + 11 * x(7))}};
}

PolynomialProgram hs106() {
  const Variables x(8);
  return {.start = values({5000, 5000, 5000, 200, 350, 150, 225, 425}),
          .x_lower = values({100, 1000, 1000, 10, 10, 10, 10, 10}),
          .x_upper = values({10000, 10000, 10000, 1000, 1000, 1000, 1000, 1000}),
          .objective = x(1) + x(2) + x(3),
          .rows = {at_least_zero(1 - 0.0025 * (x(4) + x(6))), at_least_zero(1 - 0.0025 * (x(5) + x(7) - x(4))),
                   at_least_zero(1 - 0.01 * (x(8) - x(5))),
                   at_least_zero(x(1) * x(6) - 833.33252 * x(4) - 100 * x(1) + 83333.333),
                   at_least_zero(x(2) * x(7) - 1250 * x(5) - x(2) * x(4) + 1250 * x(4)),
                   at_least_zero(x(3) * x(8) - 1250000 - x(3) * x(5) + 2500 * x(5))}};
}

PolynomialProgram hs113() {
  const Variables x(10);
  return {.start = values({2, 3, 5, 5, 1, 2, 7, 3, 6, 10}),
          .objective = square(x(1)) + square(x(2)) + x(1) * x(2) - 14 * x(1) - 16 * x(2) + square(x(3) - 10) + 4 * square(x(4) - 5) +
                       square(x(5) - 3) + 2 * square(x(6) - 1) + 5 * square(x(7)) + 7 * square(x(8) - 11) + 2 * square(x(9) - 10) +
                       square(x(10) - 7) + 45,
          .rows = {at_least_zero(105 - 4 * x(1) - 5 * x(2) + 3 * x(7) - 9 * x(8)),
                   at_least_zero(-10 * x(1) + 8 * x(2) + 17 * x(7) - 2 * x(8)),
                   at_least_zero(8 * x(1) - 2 * x(2) - 5 * x(9) + 2 * x(10) + 12),
                   at_least_zero(-3 * square(x(1) - 2) - 4 * square(x(2) - 3) - 2 * square(x(3)) + 7 * x(4) + 120),
                   at_least_zero(-5 * square(x(1)) - 8 * x(2) - square(x(3) - 6) + 2 * x(4) + 40),
                   at_least_zero(-0.5 * square(x(1) - 8) - 2 * square(x(2) - 4) - 3 * square(x(5)) + x(6) + 30),
                   at_least_zero(-square(x(1)) - 2 * square(x(2) - 2) + 2 * x(1) * x(2) - 14 * x(5) + 6 * x(6)),
                   at_least_zero(3 * x(1) - 6 * x(2) - 12 * square(x(9) - 8) + 7 * x(10))}};
}

CatalogueEntry entry(std::string name, std::string description, double published_objective, PolynomialProgram (*program)()) {
  const auto make = [name, program] {
    PolynomialProgram made = program();
    made.name = name;
    return std::make_unique<PolynomialNlp>(std::move(made));
  };
  return {name, "Hock-Schittkowski " + description, published_objective, make};
}

}  // namespace

std::vector<CatalogueEntry> hock_schittkowski() {
  return {
      entry("hs001", "1: Rosenbrock's valley with a bound (n = 2)", 0, hs001),
      entry("hs006", "6: Rosenbrock's valley as an equality (n = 2, m = 1)", 0, hs006),
      entry("hs012", "12: a quadratic in an ellipse (n = 2, m = 1)", -30, hs012),
      entry("hs021", "21: a quadratic over a half-plane in a box (n = 2, m = 1)", -99.96, hs021),
      entry("hs028", "28: linear least squares on a plane (n = 3, m = 1)", 0, hs028),
      entry("hs035", "35: Beale's convex quadratic (n = 3, m = 1)", 1.0 / 9, hs035),
      entry("hs039", "39: a linear objective on two curved surfaces (n = 4, m = 2)", -1, hs039),
      entry("hs040", "40: a product on three curved surfaces (n = 4, m = 3)", -0.25, hs040),
      entry("hs043", "43: Rosen and Suzuki's (n = 4, m = 3)", -44, hs043),
      entry("hs044", "44: an indefinite quadratic over a polytope (n = 4, m = 6)", -15, hs044),
      entry("hs065", "65: least squares in a ball and a box (n = 3, m = 1)", 0.9535288567, hs065),
      entry("hs071", "71: the one that every solver's manual solves (n = 4, m = 2)", 17.0140173, hs071),
      entry("hs076", "76: a convex quadratic over a polytope (n = 4, m = 3)", -4.681818181, hs076),
      entry("hs093", "93: the design of a transformer (n = 6, m = 2)", 135.075961, hs093),
      entry("hs100", "100: Wong's first (n = 7, m = 4)", 680.6300573, hs100),
      entry("hs106", "106: the design of a heat exchanger, badly scaled (n = 8, m = 6)", 7049.2480205, hs106),
      entry("hs113", "113: Wong's second (n = 10, m = 8)", 24.3062091, hs113),
  };
}

}  // namespace tenon
