// Tiny problems of fixed size, templates on Scalar: what a small controller would embed. AsNlp opens each of them to every back end.
#pragma once

#include <cmath>
#include <limits>

#include "tenon/core/nlp.hpp"

namespace tenon {

/// What the problems below share: sizes, and nothing to prepare.
template <class S, int N, int M>
struct FixedSize {
  using Scalar = S;
  struct Workspace {};
  static constexpr int kVariables = N;
  static constexpr int kConstraints = M;
  using VectorN = Eigen::Matrix<S, N, 1>;
  using VectorM = Eigen::Matrix<S, M, 1>;
  using Jacobian = Eigen::Matrix<S, M, N>;
  using Hessian = Eigen::Matrix<S, N, N>;
  using Bounds = BasicBounds<S, N, M>;

  int num_variables() const { return N; }
  int num_constraints() const { return M; }
  Workspace make_workspace() const { return {}; }
  void prepare(const VectorN&, Workspace&) const {}
};

/// Hock and Schittkowski 71: an inequality, an equality, and bounds on all variables.
template <class S = double>
struct EqualityAndBounds : FixedSize<S, 4, 2> {
  using B = FixedSize<S, 4, 2>;
  S product = 25;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_lower.setConstant(1), bounds.x_upper.setConstant(5);
    bounds.c_lower << product, 40;
    bounds.c_upper[1] = 40;
  }
  void initial_point(typename B::VectorN& x) const { x << 1, 5, 5, 1; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const { return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    g << x[3] * (2 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1, x[0] * (x[0] + x[1] + x[2]);
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const { c << x.prod(), x.squaredNorm(); }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const {
    j.row(0) << x[1] * x[2] * x[3], x[0] * x[2] * x[3], x[0] * x[1] * x[3], x[0] * x[1] * x[2];
    j.row(1) = 2 * x.transpose();
  }
  void hessian(const typename B::VectorN& x, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
    h(0, 0) = 2 * sigma * x[3];
    h(1, 0) = sigma * x[3] + l[0] * x[2] * x[3];
    h(2, 0) = sigma * x[3] + l[0] * x[1] * x[3];
    h(3, 0) = sigma * (2 * x[0] + x[1] + x[2]) + l[0] * x[1] * x[2];
    h(2, 1) = l[0] * x[0] * x[3];
    h(3, 1) = sigma * x[0] + l[0] * x[0] * x[2];
    h(3, 2) = sigma * x[0] + l[0] * x[0] * x[1];
    h.diagonal().array() += 2 * l[1];
  }
};

/// min (x0-3)^2 + (x1-2)^2 + x0 x1/2  s.t.  1 <= x0 + x1 <= 3,  -1/2 <= x0 - x1^2 <= 1/2,  x >= 0: the first row ends at its upper side.
template <class S = double>
struct TwoSidedRows : FixedSize<S, 2, 2> {
  using B = FixedSize<S, 2, 2>;
  S most = 3;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_lower.setZero();
    bounds.c_lower << 1, S(-0.5);
    bounds.c_upper << most, S(0.5);
  }
  void initial_point(typename B::VectorN& x) const { x << S(0.5), 2; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const {
    return (x[0] - 3) * (x[0] - 3) + (x[1] - 2) * (x[1] - 2) + x[0] * x[1] / 2;
  }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    g << 2 * (x[0] - 3) + x[1] / 2, 2 * (x[1] - 2) + x[0] / 2;
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const {
    c << x[0] + x[1], x[0] - x[1] * x[1];
  }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const { j << 1, 1, 1, -2 * x[1]; }
  void hessian(const typename B::VectorN&, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h << 2 * sigma, 0, sigma / 2, 2 * sigma - 2 * l[1];
  }
};

/// min -x0^2 + x0 x1 - x1^4 + x2  s.t.  |x|^2 = 2,  -1 <= x2 <= 1: downhill bends everywhere, so that the inertia needs correction.
template <class S = double>
struct NonConvex : FixedSize<S, 3, 1> {
  using B = FixedSize<S, 3, 1>;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_lower[2] = -1, bounds.x_upper[2] = 1;
    bounds.c_lower[0] = bounds.c_upper[0] = 2;
  }
  void initial_point(typename B::VectorN& x) const { x << S(0.3), S(0.1), S(0.2); }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const {
    return -x[0] * x[0] + x[0] * x[1] - x[1] * x[1] * x[1] * x[1] + x[2];
  }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    g << -2 * x[0] + x[1], x[0] - 4 * x[1] * x[1] * x[1], 1;
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const { c[0] = x.squaredNorm(); }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const { j = 2 * x.transpose(); }
  void hessian(const typename B::VectorN& x, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
    h.diagonal() << -2 * sigma, -12 * sigma * x[1] * x[1], 0;
    h(1, 0) = sigma;
    h.diagonal().array() += 2 * l[0];
  }
};

/// min (x0-2)^2 + (x1-3)^2 + exp(x2)  s.t.  x0 + x1 + x2 = 2,  x1 fixed at 1/2.
template <class S = double>
struct FixedVariable : FixedSize<S, 3, 1> {
  using B = FixedSize<S, 3, 1>;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_lower[1] = bounds.x_upper[1] = S(0.5);
    bounds.c_lower[0] = bounds.c_upper[0] = 2;
  }
  void initial_point(typename B::VectorN& x) const { x.setZero(); }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const {
    return (x[0] - 2) * (x[0] - 2) + (x[1] - 3) * (x[1] - 3) + std::exp(x[2]);
  }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    g << 2 * (x[0] - 2), 2 * (x[1] - 3), std::exp(x[2]);
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const { c[0] = x.sum(); }
  void jacobian(const typename B::VectorN&, typename B::Workspace&, typename B::Jacobian& j) const { j.setOnes(); }
  void hessian(const typename B::VectorN& x, S sigma, const typename B::VectorM&, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
    h.diagonal() << 2 * sigma, 2 * sigma, sigma * std::exp(x[2]);
  }
};

/// Hock and Schittkowski 65: least squares in a ball and a box, from a start where the line search gives up and restoration takes over.
template <class S = double>
struct BallAndBox : FixedSize<S, 3, 1> {
  using B = FixedSize<S, 3, 1>;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_upper << S(4.5), S(4.5), 5;
    bounds.x_lower = -bounds.x_upper;
    bounds.c_upper[0] = 48;
  }
  void initial_point(typename B::VectorN& x) const { x << -5, 5, 0; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const {
    const S difference = x[0] - x[1], sum = x[0] + x[1] - 10, last = x[2] - 5;
    return difference * difference + sum * sum / 9 + last * last;
  }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    const S difference = 2 * (x[0] - x[1]), sum = 2 * (x[0] + x[1] - 10) / 9;
    g << difference + sum, -difference + sum, 2 * (x[2] - 5);
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const { c[0] = x.squaredNorm(); }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const { j = 2 * x.transpose(); }
  void hessian(const typename B::VectorN&, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
    h.diagonal() << sigma * S(20) / 9, sigma * S(20) / 9, 2 * sigma;
    h(1, 0) = sigma * S(-16) / 9;
    h.diagonal().array() += 2 * l[0];
  }
};

/// min exp(x0) + (x1-1)^4 + x0 x2^2 + x2^2  s.t.  x0^2 + x1^2 + x2^2 = 4,  x0 + sin(x1) + x2 = 1/2: smooth, curved, without any bound.
template <class S = double>
struct CurvedEqualities : FixedSize<S, 3, 2> {
  using B = FixedSize<S, 3, 2>;

  void bounds(typename B::Bounds& bounds) const {
    bounds.c_lower << 4, S(0.5);
    bounds.c_upper = bounds.c_lower;
  }
  void initial_point(typename B::VectorN& x) const { x << 1, 1, -1; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const {
    const S d = x[1] - 1;
    return std::exp(x[0]) + d * d * d * d + (x[0] + 1) * x[2] * x[2];
  }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const {
    const S d = x[1] - 1;
    g << std::exp(x[0]) + x[2] * x[2], 4 * d * d * d, 2 * (x[0] + 1) * x[2];
  }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const {
    c << x.squaredNorm(), x[0] + std::sin(x[1]) + x[2];
  }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const {
    j.row(0) = 2 * x.transpose();
    j.row(1) << 1, std::cos(x[1]), 1;
  }
  void hessian(const typename B::VectorN& x, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    const S d = x[1] - 1;
    h.setZero();
    h.diagonal() << sigma * std::exp(x[0]), 12 * sigma * d * d - l[1] * std::sin(x[1]), 2 * sigma * (x[0] + 1);
    h(2, 0) = 2 * sigma * x[2];
    h.diagonal().array() += 2 * l[0];
  }
};

/// min x0  s.t.  x0^2 - x1 = 1,  x0 - x2 = 1/2,  x1, x2 >= 0, from (-2, 3, 1): Newton's steps with a fraction to the boundary are cut to
/// nothing before the rows are met, whatever the line search says.  [A. Waechter, L. T. Biegler, Failure of global convergence for a class
/// of interior point methods for nonlinear programming, Mathematical Programming 88 (2000)]
template <class S = double>
struct DeadEnd : FixedSize<S, 3, 2> {
  using B = FixedSize<S, 3, 2>;

  void bounds(typename B::Bounds& bounds) const {
    bounds.x_lower.template tail<2>().setZero();
    bounds.c_lower << 1, S(0.5);
    bounds.c_upper = bounds.c_lower;
  }
  void initial_point(typename B::VectorN& x) const { x << -2, 3, 1; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const { return x[0]; }
  void gradient(const typename B::VectorN&, typename B::Workspace&, typename B::VectorN& g) const { g << 1, 0, 0; }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const {
    c << x[0] * x[0] - x[1], x[0] - x[2];
  }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const {
    j << 2 * x[0], -1, 0,  //
        1, 0, -1;
  }
  void hessian(const typename B::VectorN&, S, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
    h(0, 0) = 2 * l[0];
  }
};

/// min pull x  s.t.  x - e0 >= 1,  x - e1 <= -1: no x meets both. Hard rows (D = 0) are infeasible; compliant ones settle where
/// the springs and the pull balance: at x = (D1 - D0 - pull D0 D1) / (D0 + D1) while both are strained, -1 < x < 1, and below
/// that, where the second row is met, at x = 1 - pull D0.
template <class S = double>
struct OpposedRows : FixedSize<S, 1, 2> {
  using B = FixedSize<S, 1, 2>;
  S pull = 0;
  Eigen::Matrix<S, 2, 1> compliance = Eigen::Matrix<S, 2, 1>::Zero();

  void bounds(typename B::Bounds& bounds) const {
    bounds.c_lower[0] = 1, bounds.c_upper[1] = -1;
    bounds.compliance = compliance;
  }
  void initial_point(typename B::VectorN& x) const { x[0] = 5; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const { return pull * x[0]; }
  void gradient(const typename B::VectorN&, typename B::Workspace&, typename B::VectorN& g) const { g[0] = pull; }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const { c << x[0], x[0]; }
  void jacobian(const typename B::VectorN&, typename B::Workspace&, typename B::Jacobian& j) const { j.setOnes(); }
  void hessian(const typename B::VectorN&, S, const typename B::VectorM&, typename B::Workspace&, typename B::Hessian& h) const {
    h.setZero();
  }
};

/// min 1/2 |x|^2  s.t.  x0 + 2 x1 - e = 3,  x0 x1 - e <= 2, with compliance D and preload on the first row. Hard: x = (0.6, 1.2).
template <class S = double>
struct SpringRow : FixedSize<S, 2, 2> {
  using B = FixedSize<S, 2, 2>;
  S compliance = 0, preload = 0;

  void bounds(typename B::Bounds& bounds) const {
    bounds.c_lower[0] = bounds.c_upper[0] = 3;
    bounds.c_upper[1] = 2;
    bounds.compliance[0] = compliance;
    bounds.preload[0] = preload;
  }
  void initial_point(typename B::VectorN& x) const { x << 2, -1; }
  S objective(const typename B::VectorN& x, typename B::Workspace&) const { return x.squaredNorm() / 2; }
  void gradient(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorN& g) const { g = x; }
  void constraints(const typename B::VectorN& x, typename B::Workspace&, typename B::VectorM& c) const {
    c << x[0] + 2 * x[1], x[0] * x[1];
  }
  void jacobian(const typename B::VectorN& x, typename B::Workspace&, typename B::Jacobian& j) const { j << 1, 2, x[1], x[0]; }
  void hessian(const typename B::VectorN&, S sigma, const typename B::VectorM& l, typename B::Workspace&, typename B::Hessian& h) const {
    h << sigma, 0, l[1], sigma;
  }
};

/// min f of one variable without rows: f, f', f'' as three functions, so that a case can spoil one of them.
struct OneVariable : FixedSize<double, 1, 0> {
  double start = 0;
  double (*value)(double) = nullptr;
  double (*slope)(double) = nullptr;
  double (*curvature)(double) = nullptr;

  OneVariable(double from, double (*f)(double), double (*df)(double), double (*ddf)(double))
      : start(from), value(f), slope(df), curvature(ddf) {}

  void bounds(FixedSize::Bounds&) const {}
  void initial_point(VectorN& x) const { x[0] = start; }
  double objective(const VectorN& x, Workspace&) const { return value(x[0]); }
  void gradient(const VectorN& x, Workspace&, VectorN& g) const { g[0] = slope(x[0]); }
  void constraints(const VectorN&, Workspace&, VectorM&) const {}
  void jacobian(const VectorN&, Workspace&, Jacobian&) const {}
  void hessian(const VectorN& x, double sigma, const VectorM&, Workspace&, Hessian& h) const { h(0, 0) = sigma * curvature(x[0]); }
};

/// min -x0 - x1^2  s.t.  x0 >= 0,  x0 - x1 >= -1: downhill for ever.
struct Downhill : FixedSize<double, 2, 1> {
  void bounds(FixedSize::Bounds& bounds) const {
    bounds.x_lower[0] = 0;
    bounds.c_lower[0] = -1;
  }
  void initial_point(VectorN& x) const { x.setOnes(); }
  double objective(const VectorN& x, Workspace&) const { return -x[0] - x[1] * x[1]; }
  void gradient(const VectorN& x, Workspace&, VectorN& g) const { g << -1, -2 * x[1]; }
  void constraints(const VectorN& x, Workspace&, VectorM& c) const { c[0] = x[0] - x[1]; }
  void jacobian(const VectorN&, Workspace&, Jacobian& j) const { j << 1, -1; }
  void hessian(const VectorN&, double sigma, const VectorM&, Workspace&, Hessian& h) const { h << 0, 0, 0, -2 * sigma; }
};

/// min x0 + x1  s.t.  x0^2 + x1^2 <= -1: the violation is least, and 1, at x = 0.
struct BallOfNegativeRadius : FixedSize<double, 2, 1> {
  void bounds(FixedSize::Bounds& bounds) const { bounds.c_upper[0] = -1; }
  void initial_point(VectorN& x) const { x << 1, 2; }
  double objective(const VectorN& x, Workspace&) const { return x.sum(); }
  void gradient(const VectorN&, Workspace&, VectorN& g) const { g.setOnes(); }
  void constraints(const VectorN& x, Workspace&, VectorM& c) const { c[0] = x.squaredNorm(); }
  void jacobian(const VectorN& x, Workspace&, Jacobian& j) const { j = 2 * x.transpose(); }
  void hessian(const VectorN&, double, const VectorM& l, Workspace&, Hessian& h) const { h << 2 * l[0], 0, 0, 2 * l[0]; }
};

/// Any of the above, spoilt where `spoilt(x)` says so: one of its evaluations is then not a number.
enum class Spoil { objective, gradient, constraints, jacobian, hessian };
template <class P>
struct Spoilt : P {
  Spoil what;
  bool (*spoilt)(const typename P::VectorN& x);
  using W = typename P::Workspace;

  Spoilt(Spoil evaluation, bool (*where)(const typename P::VectorN& x)) : what(evaluation), spoilt(where) {}
  bool spoils(Spoil evaluation, const typename P::VectorN& x) const { return what == evaluation && spoilt(x); }
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

  double objective(const typename P::VectorN& x, W& w) const { return spoils(Spoil::objective, x) ? kNan : P::objective(x, w); }
  void gradient(const typename P::VectorN& x, W& w, typename P::VectorN& g) const {
    P::gradient(x, w, g);
    if (spoils(Spoil::gradient, x)) g[0] = kNan;
  }
  void constraints(const typename P::VectorN& x, W& w, typename P::VectorM& c) const {
    P::constraints(x, w, c);
    if (spoils(Spoil::constraints, x)) c[0] = kNan;
  }
  void jacobian(const typename P::VectorN& x, W& w, typename P::Jacobian& j) const {
    P::jacobian(x, w, j);
    if (spoils(Spoil::jacobian, x)) j(0, 0) = kNan;
  }
  void hessian(const typename P::VectorN& x, double sigma, const typename P::VectorM& l, W& w, typename P::Hessian& h) const {
    P::hessian(x, sigma, l, w, h);
    if (spoils(Spoil::hessian, x)) h(0, 0) = kNan;
  }
};

}  // namespace tenon
