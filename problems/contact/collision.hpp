// One collision of one contact in its own time scale, its configuration frozen:  h'' + beta1 h' + beta0 h + beta3 h^3 = 0 from h = 0,
// h' = -v until h'' = 0. In closed form where beta3 = 0 (11)-(13), else integrated; e depends on v then:
//
//     beta0 = 0:  e is a function of zeta_c = beta1 beta3^-1/4 v^-1/2 alone, so that fast collisions rebound and slow ones settle
//
// The laws stand in contact.md.
#pragma once

#include <vector>

#include "tenon/problems/contact/law.hpp"

namespace tenon::contact {

/// What a collision comes to.
struct Rebound {
  double restitution;
  double time;  // s, from the touch to release
};

/// Of a law with beta0 > 0 or beta3 > 0, beta1 >= 0, at a closing speed > 0 in m/s; to 1e-10 where it is integrated.
Rebound rebound_of(const Law& law, double closing_speed);

/// A picture of it: gap, rate and force per effective mass at time tau since the touch.
struct FastPoint {
  double tau, gap, rate, acceleration;
};
std::vector<FastPoint> collision_path(const Law& law, double closing_speed, int points);

}  // namespace tenon::contact
