#include "tenon/problems/flight/reference_path.hpp"

#include <cmath>
#include <numbers>

namespace tenon::flight {

namespace {

/// A scalar that moves, with its first two derivatives.
struct Moving {
  double value, rate, acceleration;
};

/// (2.1) from 0 to 1 within the duration, at rest at both ends.
Moving smooth_step(double t, double duration) {
  if (t <= 0 && duration > 0) return {0, 0, 0};
  if (t >= duration) return {1, 0, 0};
  const double x = t / duration, back = 1 - x;
  return {x * x * x * (10 + x * (-15 + 6 * x)), 30 * x * x * back * back / duration,
          60 * x * back * (1 - 2 * x) / (duration * duration)};
}

/// (2.3) an angle whose rate rises smoothly within the ramp.
Moving ramped_angle(double t, double rate, double ramp) {
  if (t >= ramp) return {rate * (t - ramp / 2), rate, 0};
  const double x = t / ramp;
  return {rate * ramp * x * x * x * (1 - x / 2), rate * x * x * (3 - 2 * x), 6 * rate * x * (1 - x) / ramp};
}

PoseReference on_legs(const ReferencePath& path, double t) {
  PoseReference at;
  at.position = path.position;
  at.attitude = path.attitude;
  for (const Leg& leg : path.legs) {
    if (t < 0) break;
    const Moving s = smooth_step(t, leg.duration);
    // (2.2) the turn is about an axis that stands still, so that its rates are along it
    const Vector3d way = leg.position - at.position;
    at.position += s.value * way;
    at.velocity = s.rate * way;
    at.acceleration = s.acceleration * way;
    at.attitude = rotation_of(s.value * leg.turn) * at.attitude;
    at.angular_velocity = s.rate * leg.turn;
    at.angular_acceleration = s.acceleration * leg.turn;
    t -= leg.duration;
  }
  return at;
}

PoseReference tumbling(const ReferencePath& path, double t) {
  const Moving phi = ramped_angle(t, path.rate, path.ramp);
  const double c1 = 1 / std::hypot(1, std::numbers::phi), c2 = std::numbers::phi * c1;  // so that the rate is that of phi
  const Quaterniond first = rotation_of(c1 * phi.value * Vector3d::UnitX());
  // (2.4) w = phi' (c1 e_x + c2 R_x e_y),  w' = phi'' (..) + phi'^2 c1 c2 R_x e_z
  const Vector3d axis = c1 * Vector3d::UnitX() + c2 * (first * Vector3d::UnitY());
  PoseReference at;
  at.position = path.position;
  at.attitude = first * rotation_of(c2 * phi.value * Vector3d::UnitY()) * path.attitude;
  at.angular_velocity = phi.rate * axis;
  at.angular_acceleration = phi.acceleration * axis + phi.rate * phi.rate * c1 * c2 * (first * Vector3d::UnitZ());
  return at;
}

/// (2.5) a sin(n phi) with its derivatives.
Moving harmonic(double amplitude, int n, const Moving& phi) {
  const double s = std::sin(n * phi.value), c = n * std::cos(n * phi.value);
  return {amplitude * s, amplitude * c * phi.rate, amplitude * (c * phi.acceleration - n * n * s * phi.rate * phi.rate)};
}

PoseReference on_figure_eight(const ReferencePath& path, double t) {
  const Moving phi = ramped_angle(t, path.rate, path.ramp);
  const Moving x = harmonic(path.size, 1, phi), y = harmonic(path.size / 2, 2, phi), z = harmonic(path.size / 4, 1, phi);
  const Moving tilt = harmonic(path.tilt, 1, phi);
  const Vector3d axis = Vector3d(1, 1, 0).normalized();
  PoseReference at;
  at.position = path.position + Vector3d(x.value, y.value, z.value);
  at.velocity = {x.rate, y.rate, z.rate};
  at.acceleration = {x.acceleration, y.acceleration, z.acceleration};
  at.attitude = rotation_of(tilt.value * axis) * path.attitude;
  at.angular_velocity = tilt.rate * axis;
  at.angular_acceleration = tilt.acceleration * axis;
  return at;
}

}  // namespace

PoseReference ReferencePath::at(double t) const {
  switch (kind) {
    case Kind::tumble:
      return tumbling(*this, t);
    case Kind::figure_eight:
      return on_figure_eight(*this, t);
    default:
      return on_legs(*this, t);
  }
}

}  // namespace tenon::flight
