#include "tenon/problems/delta/tactile_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tenon::delta {

namespace {

constexpr double kPi = std::numbers::pi;

std::complex<double> at_frequency(double frequency) {
  return {0, 2 * kPi * frequency};
}

}  // namespace

struct TactileLoop::Parts {
  std::complex<double> control;  // C e^(-T s)
  std::complex<double> contact;  // K_c
  std::complex<double> object;   // m_o s^2 + d_o s + k_o
};

TactileLoop::TactileLoop(const Scene& scene)
    : gains_(scene.controller.law.gains),
      object_(scene.object),
      gain_(scene.controller.tactile_gain),
      delay_((scene.delay + 0.5) * scene.controller.period),
      rate_(1 / scene.controller.period) {
  for (const Contact& contact : scene.contacts) {
    if (contact.is_finger) stiffness_ += contact.stiffness, damping_ += contact.damping;
  }
  const Configuration at(inverse_kinematics(scene.robot, scene.position).q);
  const Motion motion(scene.robot, at);
  // 1/m = a' J_c M_y^-1 J_c' a
  const Vector3 torque = motion.jacobian.transpose() * scene.controller.tactile_axis;
  mass_ = 1 / torque.dot(reduced_inertia(ArmConstants(scene.robot), at, motion).llt().solve(torque));
}

TactileLoop::Parts TactileLoop::parts(std::complex<double> s) const {
  return {(gains_.proportional + gains_.derivative * s + gains_.integral / s) * std::exp(-delay_ * s), stiffness_ + damping_ * s,
          object_.mass * s * s + object_.damping * s + object_.stiffness};
}

std::complex<double> TactileLoop::impedance(double frequency) const {
  const std::complex<double> s = at_frequency(frequency);
  const Parts p = parts(s);
  const std::complex<double> yield = (1 / mass_ + p.control * gain_ / s) / (s * s + p.control);  // z/f
  return (p.object + p.contact / (1.0 + p.contact * yield)) / s;
}

std::complex<double> TactileLoop::wrist_impedance(double frequency) const {
  const std::complex<double> s = at_frequency(frequency);
  const Parts p = parts(s);
  const std::complex<double> held = p.contact / (1.0 + p.contact / p.object);  // -f/z
  return (mass_ * (s * s + p.control * (1.0 + held * gain_ / s)) + held) / s;
}

std::complex<double> TactileLoop::loop_gain(double frequency) const {
  const std::complex<double> s = at_frequency(frequency);
  const Parts p = parts(s);
  const std::complex<double> held = p.contact / (1.0 + p.contact / p.object);  // -f/z
  return gain_ / s * held * p.control / (s * s + p.control + held / mass_);
}

LoopMargins TactileLoop::margins() const {
  constexpr int kPoints = 20000;
  constexpr double kLowest = 0.01;  // Hz
  LoopMargins out;
  out.phase = std::numeric_limits<double>::infinity();
  out.delay = std::numeric_limits<double>::infinity();
  out.gain = std::numeric_limits<double>::infinity();
  std::complex<double> before = loop_gain(kLowest);
  double phase = std::arg(before);
  for (int k = 1; k <= kPoints; ++k) {
    const double frequency = kLowest * std::pow(rate_ / 2 / kLowest, static_cast<double>(k) / kPoints);
    const std::complex<double> now = loop_gain(frequency);
    const double turned = phase + std::arg(now / before);
    if ((std::abs(before) - 1) * (std::abs(now) - 1) < 0) {
      const double margin = kPi + turned;
      out.crossover = frequency;
      out.phase = std::min(out.phase, margin * 180 / kPi);
      out.delay = std::min(out.delay, margin / (2 * kPi * frequency));
    }
    if (phase > -kPi && turned <= -kPi && std::isinf(out.gain)) out.gain = 1 / std::abs(now);
    before = now;
    phase = turned;
  }
  return out;
}

}  // namespace tenon::delta
