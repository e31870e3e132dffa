// What the delta's wrist carries and what its motors rub, as parameters of the motion that motor angles and torques tell.
//
//     y'' = J_c^-1 ( z'' - J_c' y' ),    z'' of problems/delta/wrist_dynamics.hpp with payload m and damping d of the motors
//     m' = d' = 0
//
// y = (q11, q21, q31), measured; the torques are commanded. Description: delta_payload.md.
#pragma once

#include <array>

#include "tenon/core/estimation_problem.hpp"
#include "tenon/problems/delta/wrist_dynamics.hpp"

namespace tenon::delta_payload {

enum StateIndex { kAngle = 0, kRate = 3, kPayload = 6, kDamping = 7, kStates = 8 };

using State = Eigen::Matrix<double, kStates, 1>;

inline constexpr std::array<const char*, kStates> kStateNames{"q11", "q21", "q31", "v11", "v21", "v31", "payload", "damping"};

struct Parameters {
  delta::Robot robot;                // its payload and damping[0] do not count
  delta::Vector3 centre{0, 0, 0.4};  // m: where the wrist starts
  double noise = 5e-5;               // rad, of an angle: standard deviation
  double torque_ripple = 0.01;       // N m, of a motor: standard deviation of what is held over a period
  double period = 0.01;              // s
};

/// Of payload (kg) and damping (N m s): median and deviation; angles and rates follow from where the wrist starts.
struct Prior {
  State mean = State::Zero(), deviation = State::Zero();
};

/// Throws std::invalid_argument where the robot does not reach the centre.
Prior prior(const Parameters& parameters, const Eigen::Vector2d& payload, const Eigen::Vector2d& damping);

/// The robot with this payload and damping.
delta::Robot robot_with(const Parameters& parameters, double payload, double damping);

EstimationProblem estimation_problem(const Parameters& parameters, const Prior& prior, int window);

}  // namespace tenon::delta_payload
