#include "tenon/problems/contact/law.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::contact {

namespace {

/// acos(zeta) / sqrt(1 - zeta^2), continued through zeta = 1, where it is 1.
double angle_ratio(double zeta) {
  const double d = 1 - zeta;
  if (std::abs(d) < 1e-4) return 1 + d / 3 + 2 * d * d / 15;
  return zeta < 1 ? std::acos(zeta) / std::sqrt(1 - zeta * zeta) : std::acosh(zeta) / std::sqrt(zeta * zeta - 1);
}

}  // namespace

double restitution_of(double zeta) {
  return std::exp(-2 * zeta * angle_ratio(zeta));
}

double damping_ratio_of(double restitution) {
  if (restitution >= 1) return 0;
  double low = 0, high = 1;
  while (restitution_of(high) > restitution && high < 1e12) high *= 2;
  for (int k = 0; k < 200 && high - low > 1e-17 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Law law_of(double restitution, double contact_time) {
  const double zeta = damping_ratio_of(restitution), w = 2 * angle_ratio(zeta) / contact_time;
  return {w * w, 2 * zeta * w, 0};
}

double contact_time_of(const Law& law) {
  const double w = std::sqrt(law.alpha0);
  return 2 * angle_ratio(law.alpha1 / (2 * w)) / w;
}

}  // namespace tenon::contact
