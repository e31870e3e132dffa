#include "tenon/problems/contact/collision.hpp"

#include <cmath>

namespace tenon::contact {

namespace {

constexpr double kStep = 4e-3;  // of an integrated collision, in units of its fastest time

std::vector<FastPoint> linear_path(const Law& law, double closing_speed, int points) {
  // h'' + alpha1 h' + alpha0 h = 0 from h = 0, h' = -v:  two exponentials, complex below zeta = 1  (11)
  const double w = std::sqrt(law.alpha0), zeta = law.alpha1 / (2 * w), end = contact_time_of(law);
  std::vector<FastPoint> path;
  for (int k = 0; k <= points; ++k) {
    const double t = end * k / points, decay = std::exp(-zeta * w * t), d = std::abs(zeta * zeta - 1);
    double s = t, c = 1;  // of the critical law
    if (d > 1e-12) {
      const double wd = w * std::sqrt(d);
      s = zeta < 1 ? std::sin(wd * t) / wd : std::sinh(wd * t) / wd;
      c = zeta < 1 ? std::cos(wd * t) : std::cosh(wd * t);
    }
    const double gap = -closing_speed * decay * s, rate = -closing_speed * decay * (c - zeta * w * s);
    path.push_back({t, gap, rate, -law.alpha1 * rate - law.alpha0 * gap});
  }
  return path;
}

struct Motion {
  double h, hdot;
};

/// One step of the classical Runge-Kutta method.
Motion step(const Law& law, Motion at, double dt) {
  const auto slope = [&](Motion m) { return Motion{m.hdot, law.acceleration(m.h, m.hdot)}; };
  const auto ahead = [&](Motion k, double by) { return Motion{at.h + by * k.h, at.hdot + by * k.hdot}; };
  const Motion k1 = slope(at), k2 = slope(ahead(k1, dt / 2)), k3 = slope(ahead(k2, dt / 2)), k4 = slope(ahead(k3, dt));
  return {at.h + dt / 6 * (k1.h + 2 * k2.h + 2 * k3.h + k4.h), at.hdot + dt / 6 * (k1.hdot + 2 * k2.hdot + 2 * k3.hdot + k4.hdot)};
}

/// Steps that resolve both springs and the damper: w_3^2 = sqrt(beta3) v is what the cubic one comes to at this speed.
double step_length(const Law& law, double closing_speed) {
  return kStep / (std::sqrt(law.alpha0) + std::sqrt(std::sqrt(law.alpha3) * closing_speed) + law.alpha1);
}

/// When and how the contact leaves: the first h'' = 0 after the touch.
FastPoint release_of(const Law& law, double closing_speed) {
  const double dt = step_length(law, closing_speed);
  const auto pushes = [&](Motion m) { return law.acceleration(m.h, m.hdot) > 0; };
  Motion at = step(law, {0, -closing_speed}, dt);
  double t = dt;
  for (Motion next = step(law, at, dt); pushes(next); next = step(law, at, dt)) at = next, t += dt;
  double early = 0, late = dt;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (early + late);
    (pushes(step(law, at, middle)) ? early : late) = middle;
  }
  const Motion end = step(law, at, late);
  return {t + late, end.h, end.hdot, law.acceleration(end.h, end.hdot)};
}

}  // namespace

Rebound rebound_of(const Law& law, double closing_speed) {
  if (law.alpha3 == 0) return {restitution_of(law.alpha1 / (2 * std::sqrt(law.alpha0))), contact_time_of(law)};
  const FastPoint release = release_of(law, closing_speed);
  return {release.rate / closing_speed, release.tau};
}

std::vector<FastPoint> collision_path(const Law& law, double closing_speed, int points) {
  if (law.alpha3 == 0) return linear_path(law, closing_speed, points);
  const double interval = release_of(law, closing_speed).tau / points;
  const int steps = static_cast<int>(std::ceil(interval / step_length(law, closing_speed)));
  Motion at{0, -closing_speed};
  std::vector<FastPoint> path;
  for (int k = 0; k <= points; ++k) {
    path.push_back({k * interval, at.h, at.hdot, law.acceleration(at.h, at.hdot)});
    for (int j = 0; j < steps; ++j) at = step(law, at, interval / steps);
  }
  return path;
}

}  // namespace tenon::contact
