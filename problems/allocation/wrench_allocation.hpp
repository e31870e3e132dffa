// Wrench allocation: throttles u and arm angles a of N rotors that produce a wanted wrench at the least effort.
//
//     min O(u, a)   s.t.   G(u, a) = sum_i [ mu_i n_i ; mu_i r_i x n_i + s_i tau_i n_i ] - W = 0      (allocation.md derives all derivatives)
//
//     soft limits:  O = sum W_u u^2 + W_a omega^2 + W_up (throttle beyond soft limits)^2 + W_ap (rate beyond soft limit)^2
//     hard limits:  O = sum W_u u^2 + W_b (a - a_branch)^2,   bounds on throttle, angle and angle rate
//
// with omega = (a - a_prev)/dt. x = (u_1 .. u_N, a_1 .. a_N). The first is the objective of the MOMAV controller notes. Where limits are
// bounds, what the notes' other terms do is done: penalties would only compete with the wrench, and the rate term would make the arms lag.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tenon/core/nlp.hpp"
#include "tenon/core/pair_block_diagonal.hpp"
#include "tenon/problems/allocation/lane_trigonometry.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

template <int N, class S = double>
class WrenchAllocation {
 public:
  using Scalar = S;
  static constexpr int kVariables = 2 * N;
  static constexpr int kConstraints = 6;
  static constexpr int kMaxDegree = 5;  // of the thrust and torque polynomials

  using Hessian = PairBlockDiagonal<S, N>;
  using Lanes = Eigen::Array<S, N, 1>;      // one entry per rotor
  using Columns = Eigen::Matrix<S, 6, N>;   // one wrench direction per rotor
  using Wrench6 = Eigen::Matrix<S, 6, 1>;
  using VectorN = Eigen::Matrix<S, kVariables, 1>;

  /// What all evaluations at one x share.
  struct Workspace {
    Lanes cos, sin;                            // of the arm angles
    Lanes thrust, thrust_u, thrust_uu;         // mu and its derivatives
    Lanes torque, torque_u, torque_uu;         // tau and its derivatives
    Columns direction, direction_a;            // wrench per newton of thrust, and its derivative by the arm angle
    Columns drag, drag_a;                      // wrench per newton metre of drag torque, the same
  };

  /// Throws std::invalid_argument where the vehicle has not N rotors or a polynomial of more than kMaxDegree.
  explicit WrenchAllocation(const Vehicle& vehicle);

  // --- what moves from tick to tick ---------------------------------------------------------------------------------------------------------

  /// Wanted wrench in body axes (N, N m).
  void set_wrench(const Wrench6& wrench) { wrench_ = wrench; }

  /// Angles (rad) of the tick before and the time since (s).
  void set_previous(const Lanes& angles, S dt) {
    previous_ = angles;
    inverse_dt_ = 1 / dt;
    rate_term_ = true;
  }

  /// No tick before: no rate term and no rate limit.
  void forget_previous() {
    previous_.setZero();
    inverse_dt_ = 0;
    rate_term_ = false;
  }

  /// Where the arms are pulled to (rad), with hard limits.
  void set_branch(const Lanes& angles) { branch_ = angles; }

  /// Rows give way by e = D (lambda - preload): D per N^2 and (N m)^2 weights of the vehicle divided by `stiffness`; stiffness 0: hard rows.
  void set_wrench_stiffness(S stiffness) {
    for (int k = 0; k < 6; ++k) compliance_[k] = stiffness == 0 ? S(0) : 1 / (stiffness * error_weight_[k]);
  }
  /// Multiplies the whole objective: how much effort counts beside the wrench error of rows that give way.
  void set_effort_scale(S scale) {
    effort_scale_ = scale;
    w_ = scaled(weights_, scale);
  }
  S effort_scale() const { return effort_scale_; }

  void set_preload(const Wrench6& lambda) { preload_ = lambda; }

  void fail_rotor(int i) { failed_[std::size_t(i)] = true; }
  void stick_servo(int i, S angle) {
    stuck_[std::size_t(i)] = true;
    stuck_angle_[i] = angle;
  }

  // --- the contract -------------------------------------------------------------------------------------------------------------------------

  constexpr int num_variables() const { return kVariables; }
  constexpr int num_constraints() const { return kConstraints; }
  Workspace make_workspace() const { return {}; }

  void bounds(BasicBounds<S, kVariables, 6>& bounds) const;

  void prepare(const VectorN& x, Workspace& at) const {
    const Lanes u = x.template head<N>().array();
    sine_and_cosine<S, N>(x.template tail<N>().array(), at.sin, at.cos);
    evaluate(thrust_, degree_, u, at.thrust, at.thrust_u, at.thrust_uu);
    evaluate(torque_, degree_, u, at.torque, at.torque_u, at.torque_uu);
    // n = p_0 + cos p_1 + sin p_2,  n_a = -sin p_1 + cos p_2
    for (int i = 0; i < N; ++i) {
      at.direction.col(i) = thrust_at_[0].col(i) + at.cos[i] * thrust_at_[1].col(i) + at.sin[i] * thrust_at_[2].col(i);
      at.direction_a.col(i) = at.cos[i] * thrust_at_[2].col(i) - at.sin[i] * thrust_at_[1].col(i);
      at.drag.col(i) = torque_at_[0].col(i) + at.cos[i] * torque_at_[1].col(i) + at.sin[i] * torque_at_[2].col(i);
      at.drag_a.col(i) = at.cos[i] * torque_at_[2].col(i) - at.sin[i] * torque_at_[1].col(i);
    }
  }

  S objective(const VectorN& x, Workspace&) const {
    const auto u = x.template head<N>().array();
    const Lanes omega = rates(x);
    const Lanes low = (soft_lower_ - u).max(S(0)), high = (u - soft_upper_).max(S(0)), fast = (omega.abs() - soft_rate_).max(S(0));
    const Lanes astray = x.template tail<N>().array() - branch_;
    return (w_.u * u.square() + w_.a * omega.square() + w_.up * (low.square() + high.square()) + w_.ap * fast.square() +
            w_.b * astray.square())
        .sum();
  }

  /// O_u = 2 W_u u + masks,  O_a = (2/dt)(W_a omega + masks) + 2 W_b (a - a_branch)
  void gradient(const VectorN& x, Workspace&, VectorN& gradient) const {
    const auto u = x.template head<N>().array();
    const Lanes omega = rates(x);
    const Lanes beyond_u = (u - soft_upper_).max(S(0)) - (soft_lower_ - u).max(S(0));
    const Lanes beyond_omega = omega - omega.min(soft_rate_).max(-soft_rate_);
    gradient.template head<N>().array() = 2 * (w_.u * u + w_.up * beyond_u);
    gradient.template tail<N>().array() = (2 * inverse_dt_) * (w_.a * omega + w_.ap * beyond_omega) +
                                          2 * w_.b * (x.template tail<N>().array() - branch_);
  }

  void constraints(const VectorN&, Workspace& at, Wrench6& g) const {
    g.noalias() = at.direction * at.thrust.matrix();
    g.noalias() += at.drag * at.torque.matrix();
    g -= wrench_;
  }

  void jacobian(const VectorN&, Workspace& at, Eigen::Matrix<S, 6, kVariables>& j) const {
    for (int i = 0; i < N; ++i) {
      j.col(i) = at.thrust_u[i] * at.direction.col(i) + at.torque_u[i] * at.drag.col(i);
      j.col(N + i) = at.thrust[i] * at.direction_a.col(i) + at.torque[i] * at.drag_a.col(i);
    }
  }

  /// H_i = sigma O'' + lambda' G'': each direction's product with lambda is q_0 + cos q_1 + sin q_2 with three fixed vectors per rotor.
  void hessian(const VectorN& x, S sigma, const Wrench6& lambda, Workspace& at, Hessian& h) const {
    const auto u = x.template head<N>().array();
    const Lanes omega = rates(x);
    const Eigen::Matrix<S, 6 * N, 1> along = transposed_ * lambda;
    const auto lanes = [&](int k) { return along.template segment<N>(k * N).array(); };
    const Lanes f0 = lanes(0), f1 = lanes(1), f2 = lanes(2), t0 = lanes(3), t1 = lanes(4), t2 = lanes(5);
    const Lanes f_aa = -(at.cos * f1 + at.sin * f2), f_a = at.cos * f2 - at.sin * f1, f = f0 - f_aa;
    const Lanes t_aa = -(at.cos * t1 + at.sin * t2), t_a = at.cos * t2 - at.sin * t1, t = t0 - t_aa;

    const Lanes outside_u = w_.up * (u < soft_lower_ || u > soft_upper_).template cast<S>();
    const Lanes outside_omega = w_.ap * (omega.abs() > soft_rate_).template cast<S>();
    h.uu = 2 * sigma * (w_.u + outside_u) + at.thrust_uu * f + at.torque_uu * t;
    h.au = at.thrust_u * f_a + at.torque_u * t_a;
    h.aa = 2 * sigma * (inverse_dt_ * inverse_dt_ * (w_.a + outside_omega) + w_.b) + at.thrust * f_aa + at.torque * t_aa;
  }

  std::string name() const { return name_; }
  std::string variable_name(int i) const { return (i < N ? "u" : "a") + std::to_string(i % N + 1); }
  std::string constraint_name(int j) const {
    constexpr const char* kNames[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
    return kNames[j];
  }

 private:
  using Polynomial = std::array<Lanes, kMaxDegree + 1>;  // ascending coefficients

  static void evaluate(const Polynomial& p, int degree, const Lanes& u, Lanes& value, Lanes& first, Lanes& second) {
    value = p[std::size_t(degree)];
    first.setZero();
    second.setZero();
    for (int k = degree - 1; k >= 0; --k) {  // Horner, with derivatives
      second = second * u + 2 * first;
      first = first * u + value;
      value = value * u + p[std::size_t(k)];
    }
  }

  Lanes rates(const VectorN& x) const { return (x.template tail<N>().array() - previous_) * inverse_dt_; }

  // the vehicle
  std::string name_;
  std::array<Columns, 3> thrust_at_;  // [p_k; r x p_k]
  std::array<Columns, 3> torque_at_;  // [0; s p_k]
  Eigen::Matrix<S, 6 * N, 6> transposed_;  // all six, transposed, one above the other
  Polynomial thrust_, torque_;
  int degree_ = 0;  // the largest of all
  Lanes throttle_lower_, throttle_upper_, angle_lower_, angle_upper_, rate_limit_;
  Eigen::Array<bool, N, 1> tilts_;
  struct Weights {
    S u, a, up, ap, b;  // W_u, W_a, W_up, W_ap, W_b
  };
  static Weights scaled(const Weights& w, S scale) { return {w.u * scale, w.a * scale, w.up * scale, w.ap * scale, w.b * scale}; }
  Weights weights_, w_;  // as given, and times the effort scale
  S effort_scale_ = 1;
  S soft_lower_, soft_upper_, soft_rate_;
  Wrench6 error_weight_;

  // this tick
  Wrench6 wrench_ = Wrench6::Zero(), preload_ = Wrench6::Zero(), compliance_ = Wrench6::Zero();
  Lanes previous_ = Lanes::Zero(), branch_ = Lanes::Zero(), stuck_angle_ = Lanes::Zero();
  S inverse_dt_ = 0;
  bool rate_term_ = false;
  bool hard_limits_ = true;
  std::array<bool, N> failed_{}, stuck_{};
};

template <int N, class S>
WrenchAllocation<N, S>::WrenchAllocation(const Vehicle& vehicle) : name_(vehicle.name), hard_limits_(vehicle.hard_limits) {
  if (vehicle.num_rotors() != N) {
    throw std::invalid_argument("vehicle " + vehicle.name + " has " + std::to_string(vehicle.num_rotors()) + " rotors (expected " +
                                std::to_string(N) + ")");
  }
  for (auto* polynomial : {&thrust_, &torque_}) polynomial->fill(Lanes::Zero());
  for (int i = 0; i < N; ++i) {
    const Rotor& rotor = vehicle.rotors[std::size_t(i)];
    // n(a) = (x.z) x + cos a (z - (x.z) x) + sin a (x x z)
    const Eigen::Vector3d along = rotor.axis.dot(rotor.zero) * rotor.axis;
    const std::array<Eigen::Vector3d, 3> p{along, rotor.zero - along, rotor.axis.cross(rotor.zero)};
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Matrix<double, 6, 1> thrust, torque;
      thrust << p[k], rotor.position.cross(p[k]);
      torque << Eigen::Vector3d::Zero(), rotor.spin * p[k];
      thrust_at_[k].col(i) = thrust.template cast<S>();
      torque_at_[k].col(i) = torque.template cast<S>();
    }
    const auto load = [&](const std::vector<double>& coefficients, Polynomial& polynomial) {
      if (coefficients.size() > polynomial.size()) {
        throw std::invalid_argument("rotor " + std::to_string(i + 1) + " of " + vehicle.name + ": a polynomial has " +
                                    std::to_string(coefficients.size()) + " coefficients (expected at most " +
                                    std::to_string(polynomial.size()) + ")");
      }
      for (std::size_t k = 0; k < coefficients.size(); ++k) polynomial[k][i] = S(coefficients[k]);
      degree_ = std::max(degree_, int(coefficients.size()) - 1);
    };
    load(rotor.thrust, thrust_);
    load(rotor.torque, torque_);
    throttle_lower_[i] = S(rotor.throttle_lower), throttle_upper_[i] = S(rotor.throttle_upper);
    angle_lower_[i] = S(rotor.angle_lower), angle_upper_[i] = S(rotor.angle_upper);
    rate_limit_[i] = S(rotor.angle_rate_limit);
    tilts_[i] = rotor.tilt;
  }
  for (int k = 0; k < 3; ++k) {
    transposed_.template middleRows<N>(k * N) = thrust_at_[std::size_t(k)].transpose();
    transposed_.template middleRows<N>((3 + k) * N) = torque_at_[std::size_t(k)].transpose();
  }
  const AllocationWeights& weights = vehicle.weights;
  weights_ = hard_limits_ ? Weights{S(weights.throttle), 0, 0, 0, S(weights.branch)}
                    : Weights{S(weights.throttle), S(weights.angle_rate), S(weights.throttle_penalty), S(weights.angle_rate_penalty), 0};
  set_effort_scale(1);
  soft_lower_ = S(weights.throttle_soft_lower), soft_upper_ = S(weights.throttle_soft_upper), soft_rate_ = S(weights.angle_rate_soft);
  error_weight_ << Eigen::Matrix<S, 3, 1>::Constant(S(weights.force_error)), Eigen::Matrix<S, 3, 1>::Constant(S(weights.torque_error));
}

template <int N, class S>
void WrenchAllocation<N, S>::bounds(BasicBounds<S, kVariables, 6>& bounds) const {
  bounds.c_lower.setZero();
  bounds.c_upper.setZero();
  bounds.compliance = compliance_;
  bounds.preload = preload_;
  auto u_lower = bounds.x_lower.template head<N>(), u_upper = bounds.x_upper.template head<N>();
  auto a_lower = bounds.x_lower.template tail<N>(), a_upper = bounds.x_upper.template tail<N>();
  if (hard_limits_) {
    const S travel_time = rate_term_ ? 1 / inverse_dt_ : kInfinity<S>;
    u_lower = throttle_lower_, u_upper = throttle_upper_;
    a_lower = angle_lower_.max(previous_ - rate_limit_ * travel_time);
    a_upper = angle_upper_.min(previous_ + rate_limit_ * travel_time);
  } else {
    bounds.x_lower.setConstant(-kInfinity<S>);
    bounds.x_upper.setConstant(kInfinity<S>);
  }
  for (int i = 0; i < N; ++i) {
    if (failed_[std::size_t(i)]) u_lower[i] = u_upper[i] = 0;
    if (!tilts_[i]) a_lower[i] = a_upper[i] = 0;
    else if (stuck_[std::size_t(i)]) a_lower[i] = a_upper[i] = stuck_angle_[i];
  }
}

}  // namespace tenon
