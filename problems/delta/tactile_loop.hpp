// The tactile loop of a grasp, linear: what the held part feels of the robot, and how far the loop is from instability.
//
//     f = K_c (x - z),  K_c = k + d s          both fingers together; x the part, z the wrist, along the tactile axis
//     m z'' = m w + f,  w = C (r - z) e^(-T s),  C = kp + kd s + ki/s,  r = (k_f/s) f            (k_f = 0: the loop is off)
//     (m_o s^2 + d_o s + k_o) x = F - f                                                          (delta.md, section 9)
//
// The linearised robot is a mass m without friction; T is the delay and half of the hold.
#pragma once

#include <complex>

#include "tenon/problems/delta/scene.hpp"

namespace tenon::delta {

struct LoopMargins {
  double crossover = 0;  // Hz, the highest frequency at which the loop's gain is 1; 0: it is below 1 throughout
  double phase = 0;      // deg, the least at any crossover
  double delay = 0;      // s, the least further delay that makes it unstable
  double gain = 0;       // the factor that makes it unstable; infinite where none does within the band looked at
};

class TactileLoop {
 public:
  /// Asks for a scene with an object, fingers and the linearising law.
  explicit TactileLoop(const Scene& scene);

  /// F/v at the part, N s/m, at s = j 2 pi f.
  std::complex<double> impedance(double frequency) const;
  /// F/v at the wrist, which holds the part.
  std::complex<double> wrist_impedance(double frequency) const;
  /// L: the loop opened at the reference.
  std::complex<double> loop_gain(double frequency) const;
  /// Between 0.01 Hz and half of the control rate.
  LoopMargins margins() const;

 private:
  struct Parts;
  Parts parts(std::complex<double> s) const;

  Gains gains_;
  Object object_;
  double mass_ = 0, stiffness_ = 0, damping_ = 0, gain_ = 0, delay_ = 0, rate_ = 0;
};

}  // namespace tenon::delta
