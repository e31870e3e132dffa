// How far a mode is from instability: of its own loop, and of the loop through whatever it touches.
//
//     L(s) = e^{-s T} (K + D s) (M s^2 + D_c s + K_c)^{-1},     T = delay + period/2        the loop opened at the actuators    (1)
//     modulus margin  m = min_w sigma_min(I + L(jw))            every gain may change by a factor of 1/(1+m) to 1/(1-m), every
//                                                               phase by 2 asin(m/2) [Skogestad and Postlethwaite, 9.2]        (2)
//     x_{k+1} = A x_k + B_1 u_{k-d-1} + B_0 u_{k-d}             held inputs, a delay of d periods and a part of one             (3)
//     Y(s) = s (M s^2 + D_c s + K_c + e^{-s T}(K + D s))^{-1}   what the outside feels; passive where Y + Y* >= 0               (4)
//
// Coordinates are scaled by the root of the mass first, so that the margin does not depend on the units of positions and angles:
// (q, K) -> (M^{1/2} q, M^{-1/2} K M^{-1/2}).  Margins of delay and of contact stiffness are those at which (3), which knows the sampling, has an eigenvalue on the unit circle. A passive
// port is stable against every passive environment [Colgate and Hogan 1988]; sampling and delay take that away above some frequency.
#pragma once

#include "tenon/core/linear_mode.hpp"

namespace tenon {

struct ModeMargins {
  bool stable = false;
  double modulus = 0, modulus_frequency = 0;  // (2), and where, Hz
  double delay = 0;                           // s: so much more delay is borne; infinite where more than 100 periods are
  double contact_stiffness = 0;               // factor: so much stiffer a contact is borne, at the same damping ratio; infinite beyond 1e6 or without contact
  double passive_below = 0;                   // Hz: the port is passive up to here; half the sampling rate where it is throughout
};

/// Throws std::invalid_argument where the matrices do not fit, or the period is not positive.
ModeMargins mode_margins(const LinearMode& mode);

}  // namespace tenon
