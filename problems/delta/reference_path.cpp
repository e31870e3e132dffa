#include "tenon/problems/delta/reference_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon::delta {

namespace {

Reference on_circle(const ReferencePath& path, double t) {
  const double w = 2 * std::numbers::pi * path.frequency;
  const Vector3 out = path.radius * Vector3(std::cos(w * t), std::sin(w * t), 0);
  return {path.centre + out, w * Vector3(-out[1], out[0], 0), -w * w * out};
}

Vector3 slope_at(const std::vector<ReferencePath::Knot>& knots, std::size_t k) {
  if (k == 0 || k + 1 == knots.size()) return Vector3::Zero();
  return (knots[k + 1].position - knots[k - 1].position) / (knots[k + 1].t - knots[k - 1].t);
}

Reference between_knots(const std::vector<ReferencePath::Knot>& knots, double t) {
  if (t <= knots.front().t) return {knots.front().position, Vector3::Zero(), Vector3::Zero()};
  if (t >= knots.back().t) return {knots.back().position, Vector3::Zero(), Vector3::Zero()};
  const auto later =
      std::upper_bound(knots.begin(), knots.end(), t, [](double time, const ReferencePath::Knot& knot) { return time < knot.t; });
  const std::size_t k = static_cast<std::size_t>(later - knots.begin()) - 1;
  // r = p0 + h m0 s + (3 d - h (2 m0 + m1)) s^2 + (h (m0 + m1) - 2 d) s^3,   s = (t - t0)/h,   d = p1 - p0
  const double h = knots[k + 1].t - knots[k].t, s = (t - knots[k].t) / h;
  const Vector3 d = knots[k + 1].position - knots[k].position, m0 = slope_at(knots, k), m1 = slope_at(knots, k + 1);
  const Vector3 a1 = h * m0, a2 = 3 * d - h * (2 * m0 + m1), a3 = h * (m0 + m1) - 2 * d;
  return {knots[k].position + s * (a1 + s * (a2 + s * a3)), (a1 + s * (2 * a2 + s * 3 * a3)) / h, (2 * a2 + s * 6 * a3) / (h * h)};
}

}  // namespace

Reference ReferencePath::at(double t) const {
  switch (kind) {
    case Kind::circle:
      return on_circle(*this, t);
    case Kind::knots:
      return between_knots(knots, t);
    default:
      return {centre, Vector3::Zero(), Vector3::Zero()};
  }
}

}  // namespace tenon::delta
