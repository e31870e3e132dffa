// A number that knows how it varies: its value and its Taylor coefficients along K = N (N + 1)/2 directions, by the chain rule.
//
// Along direction d the variables are x + t d, and a function of them has the Taylor coefficients  v_d = d/dt,  w_d = 1/2 d^2/dt^2:
//
//     x y:   v = x_v y + y_v x,  w = x_w y + y_w x + x_v y_v        f(x):  v = f' x_v,  w = f' x_w + f''/2 x_v^2
//     x/y=q: v = (x_v - q y_v)/y,  w = (x_w - q y_w - q_v y_v)/y                                                                      (1)
//
// componentwise in d, which is one vector instruction for four of them. The directions are e_i + e_j for i < j and e_i for i = j, so that
//
//     gradient_i = v_ii,   Hessian_ii = 2 w_ii,   Hessian_ij = w_ij - w_ii - w_jj                                                     (2)
//
// Why not a library's: automatic.md. [A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM (2008), ch. 13]
#pragma once

#include <cmath>
#include <concepts>

#include "tenon/core/eigen.hpp"

namespace tenon {

template <std::floating_point Scalar, int N>
class SecondOrder {
 public:
  static constexpr int kDirections = N * (N + 1) / 2;
  using Along = Eigen::Array<Scalar, (kDirections + 3) / 4 * 4, 1>;  // whole vector registers; what is over stays 0

  SecondOrder() = default;
  SecondOrder(const SecondOrder& x) { *this = x; }
  SecondOrder& operator=(const SecondOrder& x) {
    value_ = x.value_;
    copy(x.v_, v_);
    copy(x.w_, w_);
    return *this;
  }
  SecondOrder(Scalar constant) : value_(constant), v_(Along::Zero()), w_(Along::Zero()) {}  // implicit: formulas mix numbers and variables

  /// The variable x_i, with this value.
  static SecondOrder variable(int i, Scalar value) {
    SecondOrder x(value);
    for (int j = 0; j < N; ++j) x.v_[direction(i, j)] = 1;
    return x;
  }

  Scalar value() const { return value_; }
  const Along& second() const { return w_; }  // w
  Scalar derivative(int i) const { return v_[direction(i, i)]; }

  /// (2) of any linear combination of second().
  static Scalar hessian(const Along& w, int i, int j) {
    return i == j ? 2 * w[direction(i, i)] : w[direction(i, j)] - w[direction(i, i)] - w[direction(j, j)];
  }

  /// f(x) where f, its first and its second derivative at x are these.  (1)
  friend SecondOrder chain(const SecondOrder& x, Scalar f, Scalar f1, Scalar f2) {
    return {f, f1 * x.v_, f1 * x.w_ + (f2 / 2) * (x.v_ * x.v_)};
  }

  friend SecondOrder operator+(const SecondOrder& x, const SecondOrder& y) { return {x.value_ + y.value_, x.v_ + y.v_, x.w_ + y.w_}; }
  friend SecondOrder operator-(const SecondOrder& x, const SecondOrder& y) { return {x.value_ - y.value_, x.v_ - y.v_, x.w_ - y.w_}; }
  friend SecondOrder operator*(const SecondOrder& x, const SecondOrder& y) {
    return {x.value_ * y.value_, x.v_ * y.value_ + y.v_ * x.value_, x.w_ * y.value_ + y.w_ * x.value_ + x.v_ * y.v_};
  }
  friend SecondOrder operator/(const SecondOrder& x, const SecondOrder& y) {
    const Scalar inverse = 1 / y.value_, q = x.value_ * inverse;
    SecondOrder out;
    out.value_ = q;
    out.v_ = (x.v_ - q * y.v_) * inverse;
    out.w_ = (x.w_ - q * y.w_ - out.v_ * y.v_) * inverse;
    return out;
  }

  friend SecondOrder operator+(const SecondOrder& x, Scalar c) {
    SecondOrder out = x;
    out.value_ += c;
    return out;
  }
  friend SecondOrder operator-(const SecondOrder& x, Scalar c) { return x + (-c); }
  friend SecondOrder operator*(const SecondOrder& x, Scalar c) { return {x.value_ * c, x.v_ * c, x.w_ * c}; }
  friend SecondOrder operator/(const SecondOrder& x, Scalar c) { return x * (1 / c); }
  friend SecondOrder operator+(Scalar c, const SecondOrder& x) { return x + c; }
  friend SecondOrder operator-(Scalar c, const SecondOrder& x) { return {c - x.value_, -x.v_, -x.w_}; }
  friend SecondOrder operator*(Scalar c, const SecondOrder& x) { return x * c; }
  friend SecondOrder operator/(Scalar c, const SecondOrder& x) { return c * reciprocal(x); }
  friend SecondOrder operator+(const SecondOrder& x) { return x; }
  friend SecondOrder operator-(const SecondOrder& x) { return {-x.value_, -x.v_, -x.w_}; }

  SecondOrder& operator+=(const SecondOrder& y) { return *this = *this + y; }
  SecondOrder& operator-=(const SecondOrder& y) { return *this = *this - y; }
  SecondOrder& operator*=(const SecondOrder& y) { return *this = *this * y; }
  SecondOrder& operator/=(const SecondOrder& y) { return *this = *this / y; }

  /// By value: a branch takes the derivatives of the side it goes to.
  friend auto operator<=>(const SecondOrder& x, const SecondOrder& y) { return x.value_ <=> y.value_; }
  friend bool operator==(const SecondOrder& x, const SecondOrder& y) { return x.value_ == y.value_; }

  friend SecondOrder reciprocal(const SecondOrder& x) {
    const Scalar f = 1 / x.value_;
    return chain(x, f, -f * f, 2 * f * f * f);
  }
  friend SecondOrder sin(const SecondOrder& x) {
    const Scalar s = std::sin(x.value_), c = std::cos(x.value_);
    return chain(x, s, c, -s);
  }
  friend SecondOrder cos(const SecondOrder& x) {
    const Scalar s = std::sin(x.value_), c = std::cos(x.value_);
    return chain(x, c, -s, -c);
  }
  friend SecondOrder tan(const SecondOrder& x) {
    const Scalar t = std::tan(x.value_), t1 = 1 + t * t;
    return chain(x, t, t1, 2 * t * t1);
  }
  friend SecondOrder atan(const SecondOrder& x) {
    const Scalar f1 = 1 / (1 + x.value_ * x.value_);
    return chain(x, std::atan(x.value_), f1, -2 * x.value_ * f1 * f1);
  }
  friend SecondOrder tanh(const SecondOrder& x) {
    const Scalar t = std::tanh(x.value_), t1 = 1 - t * t;
    return chain(x, t, t1, -2 * t * t1);
  }
  friend SecondOrder exp(const SecondOrder& x) {
    const Scalar e = std::exp(x.value_);
    return chain(x, e, e, e);
  }
  friend SecondOrder log(const SecondOrder& x) {
    const Scalar f1 = 1 / x.value_;
    return chain(x, std::log(x.value_), f1, -f1 * f1);
  }
  friend SecondOrder sqrt(const SecondOrder& x) {
    const Scalar r = std::sqrt(x.value_), f1 = 1 / (2 * r);
    return chain(x, r, f1, -f1 / (2 * x.value_));
  }
  friend SecondOrder pow(const SecondOrder& x, Scalar p) {
    const Scalar f = std::pow(x.value_, p - 2);
    return chain(x, f * x.value_ * x.value_, p * f * x.value_, p * (p - 1) * f);
  }
  friend SecondOrder square(const SecondOrder& x) {
    return {x.value_ * x.value_, (2 * x.value_) * x.v_, (2 * x.value_) * x.w_ + x.v_ * x.v_};
  }
  friend SecondOrder abs(const SecondOrder& x) { return x.value_ < 0 ? -x : x; }

 private:
  template <class V, class W>
  SecondOrder(Scalar value, const V& v, const W& w) : value_(value), v_(v), w_(w) {}

  /// By whole vector registers: compilers may copy an array in pieces, and whoever reads a register of it then waits for all of them.
  static void copy(const Along& from, Along& to) { to = Along::Map(from.data()); }

  /// The place of e_i + e_j, or e_i: row by row in the upper triangle.
  static constexpr int direction(int i, int j) {
    const int low = i < j ? i : j, high = i < j ? j : i;
    return low * N - low * (low - 1) / 2 + high - low;
  }

  Scalar value_;
  Along v_, w_;
};

}  // namespace tenon
