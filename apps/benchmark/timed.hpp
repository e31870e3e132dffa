// Clocks around the two parts of a solve: the evaluations of the problem, and the linear algebra.
//
//     NewtonKkt<Timed<P>, TimedKkt<KktOf<P>>>     is    NewtonKkt<P>    with both on the clock.
#pragma once

#include <chrono>

#include "tenon/solvers/newton_kkt/kkt_of.hpp"

namespace tenon {

class Stopwatch {
 public:
  /// Adds the time of f() and returns its result.
  template <class F>
  decltype(auto) time(F&& f) {
    struct Lap {
      Stopwatch& watch;
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      ~Lap() { watch.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
    } lap{*this};
    return f();
  }
  double seconds = 0;
};

inline thread_local Stopwatch linear_algebra_watch, evaluation_watch;

template <class Kkt>
class TimedKkt : public Kkt {
 public:
  using Kkt::Kkt;
  Inertia factor(const auto&... arguments) {
    return linear_algebra_watch.time([&] { return Kkt::factor(arguments...); });
  }
  double solve(const auto& r_x, const auto& r_c, auto&& dx, auto&& dlambda) {
    return linear_algebra_watch.time([&] { return Kkt::solve(r_x, r_c, dx, dlambda); });
  }
};

/// A problem that is an Nlp, and final.
template <class P>
class Timed {
 public:
  using Scalar = double;
  using Workspace = Nlp::Workspace;
  static constexpr int kVariables = Dynamic, kConstraints = Dynamic;

  explicit Timed(const P& problem) : problem_(problem) {}

  int num_variables() const { return problem_.num_variables(); }
  int num_constraints() const { return problem_.num_constraints(); }
  Stages stages() const { return problem_.stages(); }
  SparsePattern jacobian_pattern() const { return problem_.jacobian_pattern(); }
  SparsePattern hessian_pattern() const { return problem_.hessian_pattern(); }
  void bounds(Bounds& bounds) const { problem_.bounds(bounds); }
  Workspace make_workspace() const { return problem_.make_workspace(); }

  void prepare(const Vector& x, Workspace& at) const {
    evaluation_watch.time([&] { problem_.prepare(x, at); });
  }
  double objective(const Vector& x, Workspace& at) const {
    return evaluation_watch.time([&] { return problem_.objective(x, at); });
  }
  void gradient(const Vector& x, Workspace& at, Vector& gradient) const {
    evaluation_watch.time([&] { problem_.gradient(x, at, gradient); });
  }
  void constraints(const Vector& x, Workspace& at, Vector& values) const {
    evaluation_watch.time([&] { problem_.constraints(x, at, values); });
  }
  void jacobian(const Vector& x, Workspace& at, std::span<double> values) const {
    evaluation_watch.time([&] { problem_.jacobian(x, at, values); });
  }
  void hessian(const Vector& x, double sigma, const Vector& lambda, Workspace& at, std::span<double> values) const {
    evaluation_watch.time([&] { problem_.hessian(x, sigma, lambda, at, values); });
  }

 private:
  const P& problem_;
};

}  // namespace tenon
