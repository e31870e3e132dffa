#include "tenon/problems/touch_down/plane_estimator.hpp"

#include <algorithm>

namespace tenon::touch_down {

namespace {

constexpr double kLittle = 2e-4;        // m: how far ahead the plane is believed where the force was lost again
constexpr double kContactError = 5e-5;  // m: what the contact gives way, and so how well a felt plane is known

}  // namespace

void PlaneEstimator::reset() {
  felt_ = false;
  plane_ = passed_ = knowledge_.plane - knowledge_.uncertainty;
}

void PlaneEstimator::update(double, ConstVectorRef measurements, ConstVectorRef) {
  const double z = measurements[0], force = measurements[2], peak = measurements[3];
  felt_ = felt_ || peak > knowledge_.threshold;
  passed_ = std::max(passed_, z);
  if (!felt_)
    plane_ = std::max(plane_, z + knowledge_.margin);
  else if (force > knowledge_.threshold)
    plane_ = z;
  else
    plane_ = std::max(plane_, z + kLittle);
}

void PlaneEstimator::covariance(MatrixRef values) const {
  // a uniform range of length l has the variance l^2 / 12
  const double range = std::max(0.0, knowledge_.plane + knowledge_.uncertainty - passed_);
  values.setZero();
  values(0, 0) = felt_ ? kContactError * kContactError : range * range / 12;
}

}  // namespace tenon::touch_down
