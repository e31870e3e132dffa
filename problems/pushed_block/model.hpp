// A finger pushes a block over a table: how both move, with what is not known of the block among the states.
//
//     m_f v_f' = F - lambda,      m_b v_b' = lambda - mu m_b g tanh(v_b / v_s),      m_b' = mu' = 0
//     lambda = k d log(1 + exp((x_f - x_b) / d)),      both measured at the touching faces: positive where they overlap
//
// The finger's soft pad is the contact's law, so that one set of equations holds before, at and after touch. pushed_block.md.
#pragma once

#include <array>
#include <string>

#include "tenon/core/estimation_problem.hpp"

namespace tenon::pushed_block {

enum StateIndex { kFinger, kBlock, kFingerRate, kBlockRate, kBlockMass, kFriction, kStates };

inline constexpr std::array<const char*, kStates> kStateNames{"finger", "block", "finger_rate", "block_rate", "block_mass", "friction"};

using State = Eigen::Matrix<double, kStates, 1>;

struct Parameters {
  double finger_mass = 0.5;  // kg
  double stiffness = 300;    // N/m, of the pad
  double softness = 1e-3;    // m: d
  double slip_speed = 0.02;  // m/s: v_s
  double gravity = 9.81;
  double noise = 2e-5;                                 // m, of the finger's position: standard deviation
  double force_ripple = 0.05, friction_ripple = 0.02;  // N, standard deviations of what is held over a period
  double period = 0.01;                                // s
};

/// What is known before the experiment, as far as it is uncertain; deviations of what is at rest and known are small, not 0.
struct Prior {
  State mean = State::Zero(), deviation = State::Zero();
};

/// N: what the pad carries.
double contact_force(const Parameters& parameters, const State& x);

/// The Dae, with F as its input; measured is the finger's position.
EstimationProblem estimation_problem(const Parameters& parameters, const Prior& prior, int window);

}  // namespace tenon::pushed_block
