// The accelerations of a pole on a cart with their derivatives, and one Runge-Kutta step of them, for four intervals at once.
//
//     D(theta) = M + m sin^2,    a = (u + m l omega^2 sin + m g cos sin) / D,    alpha = -(a cos + g sin) / l              swing_up.md (1)
#pragma once

#include "tenon/problems/allocation/lane_trigonometry.hpp"

namespace tenon {

using Lane = Eigen::Array<double, 4, 1>;  // four intervals

struct PoleOnCart {
  double cart_mass, pole_mass, length, gravity;
  double orientation;  // 1: the angle is counted from hanging; -1: from upright

  /// Acceleration of the cart at one point, with what its derivatives need.
  struct Acceleration {
    Lane sine, cosine, omega;
    Lane a, a_theta, a_omega, a_u;                  // of the cart
    Lane alpha, alpha_theta, alpha_omega, alpha_u;  // of the pole
  };

  // (2)
  void evaluate(const Lane& theta, const Lane& omega, const Lane& u, Acceleration& at) const {
    Lane s, c;
    sine_and_cosine(theta, s, c);
    s *= orientation, c *= orientation;
    const double ml = pole_mass * length, mg = pole_mass * gravity, inverse_length = 1 / length;
    const Lane swing = ml * omega * s;
    const Lane inverse = 1 / (cart_mass + pole_mass * s * s);
    at.sine = s, at.cosine = c, at.omega = omega;
    at.a = (u + omega * swing + mg * (c * s)) * inverse;
    at.a_u = inverse;
    at.a_omega = 2 * swing * inverse;
    at.a_theta = (ml * omega * omega * c + mg * (c * c - s * s) - at.a * (2 * pole_mass) * (s * c)) * inverse;
    at.alpha = -(c * at.a + gravity * s) * inverse_length;
    at.alpha_theta = (s * at.a - c * at.a_theta - gravity * c) * inverse_length;
    at.alpha_omega = -(c * at.a_omega) * inverse_length;
    at.alpha_u = -(c * at.a_u) * inverse_length;
  }

  /// Second derivatives of  weight_a a + weight_alpha alpha.
  struct Curvature {
    Lane theta_theta, theta_omega, theta_u, omega_omega;
  };

  // (3)
  Curvature curvature(const Acceleration& at, const Lane& weight_a, const Lane& weight_alpha) const {
    const Lane &s = at.sine, &c = at.cosine;
    const double ml = pole_mass * length, mg = pole_mass * gravity;
    const Lane slope = 2 * pole_mass * s * c, bend = 2 * pole_mass * (c * c - s * s);  // D', D''
    const Lane of_alpha = weight_alpha / length, of_a = weight_a - of_alpha * c;
    const Lane a_theta_theta = (-ml * at.omega * at.omega * s - 4 * mg * s * c - 2 * at.a_theta * slope - at.a * bend) * at.a_u;
    const Lane a_theta_omega = (2 * ml * at.omega * c - at.a_omega * slope) * at.a_u;
    const Lane a_theta_u = -at.a_u * slope * at.a_u;
    const Lane a_omega_omega = 2 * ml * s * at.a_u;
    return {of_a * a_theta_theta + of_alpha * (c * at.a + 2 * s * at.a_theta + gravity * s),
            of_a * a_theta_omega + of_alpha * s * at.a_omega, of_a * a_theta_u + of_alpha * s * at.a_u, of_a * a_omega_omega};
  }
};

/// x(h) = F(x, u) by the classical Runge-Kutta method, with its derivatives.
struct RungeKuttaStep {
  PoleOnCart::Acceleration at[4];
  Lane d_theta[4][3], d_omega[4][3];  // angle and rate at each of the four points by (theta, omega, u) at the beginning
  Lane end[4];                        // position, angle, velocity, rate at the end
  Lane d_end[4][3];                   // the same by (theta, omega, u); by position and velocity: 1, 1 and h

  /// weights of the four slopes in the velocity, and of their sum for the position  (4)
  static constexpr double kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  static constexpr double kDoubleWeight[4] = {1.0 / 6, 1.0 / 6, 1.0 / 6, 0};
  static constexpr double kReach[4] = {0, 0.5, 0.5, 1};

  // (4), (5)
  void run(const PoleOnCart& pole, double h, const Lane& position, const Lane& theta, const Lane& velocity, const Lane& omega,
           const Lane& u) {
    Lane sum_a = Lane::Zero(), sum_alpha = Lane::Zero(), double_a = Lane::Zero(), double_alpha = Lane::Zero();
    for (auto& row : d_end) {
      for (Lane& entry : row) entry.setZero();
    }
    Lane point_omega = omega;  // of the point before
    for (int i = 0; i < 4; ++i) {
      const double reach = kReach[i] * h;
      Lane d_alpha_before[3];
      for (int d = 0; d < 3; ++d) d_alpha_before[d] = i == 0 ? Lane::Zero() : d_alpha(i - 1, d);
      const Lane point_theta = theta + reach * point_omega;
      if (i > 0) point_omega = omega + reach * at[i - 1].alpha;
      for (int d = 0; d < 3; ++d) {
        d_theta[i][d] = i == 0 ? Lane::Zero() : Lane(reach * d_omega[i - 1][d]);
        d_omega[i][d] = reach * d_alpha_before[d];
      }
      d_theta[i][0] += 1;
      d_omega[i][1] += 1;
      pole.evaluate(point_theta, point_omega, u, at[i]);
      const double w = kWeight[i], ww = kDoubleWeight[i];
      sum_a += w * at[i].a, sum_alpha += w * at[i].alpha;
      double_a += ww * at[i].a, double_alpha += ww * at[i].alpha;
      for (int d = 0; d < 3; ++d) {
        const Lane by_a = d_a(i, d), by_alpha = d_alpha(i, d);
        d_end[0][d] += (h * h * ww) * by_a, d_end[2][d] += (h * w) * by_a;
        d_end[1][d] += (h * h * ww) * by_alpha, d_end[3][d] += (h * w) * by_alpha;
      }
    }
    end[0] = position + h * velocity + (h * h) * double_a;
    end[1] = theta + h * omega + (h * h) * double_alpha;
    end[2] = velocity + h * sum_a;
    end[3] = omega + h * sum_alpha;
    d_end[1][0] += 1, d_end[1][1] += h, d_end[3][1] += 1;
  }

  /// Second derivatives of lambda' F by (theta, omega, u): the entries (0,0) (1,0) (2,0) (1,1) (2,1) (2,2). Backwards through the points.
  /// (6)
  void hessian(const PoleOnCart& pole, double h, const Lane lambda[4], Lane out[6]) const {
    for (int e = 0; e < 6; ++e) out[e].setZero();
    Lane theta_bar = Lane::Zero(), omega_bar = Lane::Zero();  // of the point behind
    for (int i = 3; i >= 0; --i) {
      const double reach_behind = i < 3 ? kReach[i + 1] * h : 0;
      const Lane a_bar = (h * h * kDoubleWeight[i]) * lambda[0] + (h * kWeight[i]) * lambda[2];
      const Lane alpha_bar = (h * h * kDoubleWeight[i]) * lambda[1] + (h * kWeight[i]) * lambda[3] + reach_behind * omega_bar;
      const PoleOnCart::Curvature k = pole.curvature(at[i], a_bar, alpha_bar);
      Lane by_theta[3], by_omega[3];
      for (int d = 0; d < 3; ++d) {
        by_theta[d] = k.theta_theta * d_theta[i][d] + k.theta_omega * d_omega[i][d];
        by_omega[d] = k.theta_omega * d_theta[i][d] + k.omega_omega * d_omega[i][d];
      }
      by_theta[2] += k.theta_u;
      for (int d = 0, e = 0; d < 3; ++d) {
        for (int r = d; r < 3; ++r, ++e) out[e] += d_theta[i][r] * by_theta[d] + d_omega[i][r] * by_omega[d];
      }
      out[2] += k.theta_u * d_theta[i][0], out[4] += k.theta_u * d_theta[i][1], out[5] += k.theta_u * d_theta[i][2];
      const Lane theta_behind = theta_bar;
      theta_bar = a_bar * at[i].a_theta + alpha_bar * at[i].alpha_theta;
      omega_bar = a_bar * at[i].a_omega + alpha_bar * at[i].alpha_omega + reach_behind * theta_behind;
    }
  }

 private:
  Lane d_a(int i, int d) const { return chain(at[i].a_theta, at[i].a_omega, at[i].a_u, i, d); }
  Lane d_alpha(int i, int d) const { return chain(at[i].alpha_theta, at[i].alpha_omega, at[i].alpha_u, i, d); }
  Lane chain(const Lane& by_theta, const Lane& by_omega, const Lane& by_u, int i, int d) const {
    const Lane along = by_theta * d_theta[i][d] + by_omega * d_omega[i][d];
    return d == 2 ? Lane(along + by_u) : along;
  }
};

}  // namespace tenon
