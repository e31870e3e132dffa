#include <stdexcept>

#include "tenon/problems/optimal_control/linear_quadratic.hpp"

namespace tenon {

namespace {

/// exp(m), by the series of a small multiple and repeated squaring.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& m) {
  constexpr int kHalvings = 10, kTerms = 12;
  const Eigen::MatrixXd small = m / (1 << kHalvings);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(m.rows(), m.cols()), term = sum;
  for (int k = 1; k <= kTerms; ++k) {
    term = (term * small / k).eval();
    sum += term;
  }
  for (int k = 0; k < kHalvings; ++k) sum = (sum * sum).eval();
  return sum;
}

}  // namespace

LinearQuadraticProgram mass_spring_chain(int states, int inputs, int intervals) {
  const int masses = states / 2;
  if (states % 2 != 0 || inputs < 1 || inputs > masses || intervals < 1) {
    throw std::invalid_argument("lq: " + std::to_string(states) + " states, " + std::to_string(inputs) + " inputs, " +
                                std::to_string(intervals) +
                                " intervals (expected two states for each mass, no more inputs than masses, at least one interval)");
  }
  constexpr double kStiffness = 1, kMass = 1, kPeriod = 0.5, kMostForce = 0.5, kDisplacement = 2.5;

  //  d/dt [ q; v; u ] = [ 0  I  0; K/m  0  B/m; 0  0  0 ] [ q; v; u ],    u held over a period
  Eigen::MatrixXd flow = Eigen::MatrixXd::Zero(states + inputs, states + inputs);
  for (int i = 0; i < masses; ++i) {
    flow(i, masses + i) = 1;
    flow(masses + i, i) = -2 * kStiffness / kMass;
    if (i > 0) flow(masses + i, i - 1) = kStiffness / kMass;
    if (i + 1 < masses) flow(masses + i, i + 1) = kStiffness / kMass;
    if (i < inputs) flow(masses + i, states + i) = 1 / kMass;
  }
  const Eigen::MatrixXd transition = exponential(kPeriod * flow);

  LinearQuadraticProgram program;
  program.a = transition.topLeftCorner(states, states);
  program.b = transition.topRightCorner(states, inputs);
  program.state_weight.setOnes(states);
  program.input_weight.setConstant(inputs, 2);
  program.largest_input = kMostForce;
  program.initial.setZero(states);
  program.initial.head(std::min(2, masses)).setConstant(kDisplacement);
  program.intervals = intervals;
  return program;
}

}  // namespace tenon
