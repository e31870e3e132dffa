#include "tenon/problems/touch_down/tracking.hpp"

#include <algorithm>

namespace tenon::touch_down {

void TrackingLaw::update(double t, ConstVectorRef measurements, VectorRef commands) {
  const double z = measurements[0], v = measurements[1], p = settings_.pole;
  const double way = settings_.plane - settings_.start, time = settings_.time, s = std::min(1.0, t / time);
  const double r = settings_.start + way * s * s * s * (10 + s * (-15 + 6 * s));
  const double r_rate = way / time * 30 * s * s * (1 - s) * (1 - s);
  const double r_acceleration = way / (time * time) * 60 * s * (1 - s) * (1 - 2 * s);
  const double push = t < time ? 0 : settings_.force / settings_.mass;
  const double w = r_acceleration + 2 * p * (r_rate - v) + p * p * (r - z) + push;
  commands[0] = std::clamp(w, -settings_.largest_input, settings_.largest_input);
}

}  // namespace tenon::touch_down
