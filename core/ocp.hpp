// An optimal control problem over a Dae, in phases p = 1 .. P, each in one mode:
//
//     min   sum_p  integral_0^T_p L_p(x, y, u) dt + E_p(x(T_p)) + w_p T_p
//     s.t.  F(mode_p, t, xdot, x, y, u) = 0,     x, y, u and rows g_p(x, y, u) within bounds,     u constant on each interval,
//           x(0), x(T_p) and rows e_p(x(T_p)) within bounds,    T_p fixed, or within bounds,
//           x_{p+1}(0) = R_p(x_p(T_p)):  continuous, or what an impact makes of it
//
// It knows neither transcription nor solver: mpc makes nonlinear programs of it. Where a duration is free, the Dae is autonomous.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tenon/core/dae.hpp"
#include "tenon/core/smooth_function.hpp"

namespace tenon {

/// lower <= value <= upper, entry by entry; no limit where nothing was set.
struct Box {
  Vector lower, upper;

  Box() = default;
  explicit Box(int n);
  void limit(int i, double low, double high) { lower[i] = low, upper[i] = high; }
  void fix(int i, double value) { limit(i, value, value); }
};

/// Contacts whose forces are inputs, u[first_input + i] = lambda_i >= 0, and exclude their gaps. Derivation: mpc/collocation.md.
struct Complementarity {
  enum class Product {
    gap,        // h_i >= 0,  lambda_i h_i <= epsilon at both ends of the interval on which lambda_i is constant
    baumgarte,  // w_i >= 0,  lambda_i w_i <= epsilon at its end: permits a force at a distance; for comparison
  };
  Product product = Product::gap;
  int first_input = 0;
  std::shared_ptr<const SmoothFunction> gaps;     // h(x), one for each contact
  std::shared_ptr<const SmoothFunction> barrier;  // w(x, y, u) = h'' + alpha1 h' + alpha0 h >= 0; with `gap` it may be left out
  double epsilon = 1e-5;                          // J: N times m
};

struct OcpPhase {
  /// Of the right sizes and without any limit, 1 s long.
  explicit OcpPhase(const Dae& dae);

  std::string name;
  DaeMode mode;
  int intervals = 20;                // of the first mesh
  double duration = 1;               // s, where it is free: the guess
  double shortest = 0, longest = 0;  // s: the duration is free between them where shortest < longest

  Box x, y, u;                                     // all along the phase
  Box start, end;                                  // of x besides
  std::shared_ptr<const SmoothFunction> cost;      // L(x, y, u), one value; null for none
  std::shared_ptr<const SmoothFunction> end_cost;  // E(x), one value
  double time_weight = 0;                          // w, 1/s
  std::shared_ptr<const SmoothFunction> rows;      // g(x, y, u)
  Box rows_box;
  std::shared_ptr<const SmoothFunction> end_rows;  // e(x), such as the guard that ends the phase
  Box end_rows_box;
  std::shared_ptr<const SmoothFunction> link;  // R(x), nx values; null for continuity
  std::shared_ptr<const Complementarity> contact;

  /// A point to start from at this fraction of the phase, 0 to 1; vectors arrive as 0. By default x goes straight from the middle of
  /// `start` to that of `end`, as far as they have limits on both sides.
  std::function<void(double fraction, VectorRef x, VectorRef y, VectorRef u)> guess;

  bool has_free_duration() const { return shortest < longest; }
};

struct Ocp {
  std::string name = "ocp";
  std::shared_ptr<const Dae> dae;
  std::vector<OcpPhase> phases;
};

/// Throws std::invalid_argument, naming phase and part, where sizes do not fit, bounds cross, a duration or a number of intervals makes no
/// sense.
void validate(const Ocp& ocp);

/// What the phase starts from: its own guess, or the straight line.
void guess_at(const OcpPhase& phase, double fraction, VectorRef x, VectorRef y, VectorRef u);

}  // namespace tenon
