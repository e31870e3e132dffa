// A plan: the solution of an optimal control problem as a function of time, a polynomial for each interval.
//
//     x(t) = sum_j X_j l_j(tau)   through tau = 0, c_1, .., c_s;      y(t) through c_1, .., c_s;      u constant;     tau = (t - t_k)/h_k
//
// l_j: the Lagrange polynomials. It is continuous within a phase; between phases x may jump.
#pragma once

#include <vector>

#include "tenon/core/dae.hpp"

namespace tenon {

struct PlanInterval {
  int phase = 0;
  double t = 0, length = 0;  // s
  Eigen::MatrixXd x;         // nx x (s + 1)
  Eigen::MatrixXd y;         // ny x s
  Vector u;                  // nu
};

class Plan {
 public:
  Plan() = default;
  /// abscissae: 0, c_1, .., c_s, distinct; intervals in the order of time, at least one; modes: one for each phase.
  Plan(Vector abscissae, std::vector<PlanInterval> intervals, std::vector<DaeMode> modes);

  const std::vector<PlanInterval>& intervals() const { return intervals_; }
  const std::vector<DaeMode>& modes() const { return modes_; }
  double duration() const { return intervals_.back().t + intervals_.back().length; }

  /// At time t (s), clamped to the plan: x, xdot, y, u and mode. At the border of two intervals the later one counts.
  DaeState at(double t) const;
  /// The same in interval k, at tau from 0 to 1.
  DaeState at(std::size_t k, double tau) const;

  /// The rows of a record (core/trajectory.hpp): `points` in every interval, and both ends of every phase.
  std::vector<DaeState> samples(int points) const;

 private:
  Vector abscissae_;
  std::vector<PlanInterval> intervals_;
  std::vector<DaeMode> modes_;
};

/// Of the polynomial through values at these points (n): the weights with which they make its value at tau, and its derivative.
void interpolation_weights(ConstVectorRef points, double tau, VectorRef value, VectorRef derivative);

}  // namespace tenon
