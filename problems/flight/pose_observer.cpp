#include "tenon/problems/flight/pose_observer.hpp"

namespace tenon::flight {

PoseObserver::PoseObserver(const RigidBody& body, double bandwidth, double period) : body_(body), period_(period) {
  const double b = std::exp(-bandwidth * period), c = 1 - b;
  pose_gain_ = 1 - b * b * b;
  rate_gain_ = 1.5 * c * c * (1 + b) / period;
  acceleration_gain_ = c * c * c / (period * period);
}

void PoseObserver::predict(const Wrench& wrench, BodyEstimate& at) const {
  const double T = period_;
  const Vector3d acceleration = body_.acceleration(wrench.head<3>(), at.attitude) + at.unexplained;
  const Vector3d angular = body_.angular_acceleration(wrench.tail<3>(), at.rate) + at.unexplained_angular;
  at.position += T * (at.velocity + T / 2 * acceleration);
  at.velocity += T * acceleration;
  at.attitude = (at.attitude * rotation_of(T * (at.rate + T / 2 * angular))).normalized();
  at.rate += T * angular;
}

void PoseObserver::correct(const PoseMeasurement& measured, BodyEstimate& at) const {
  const Vector3d moved = measured.position - at.position;
  const Vector3d turned = rotation_vector(at.attitude.conjugate() * measured.attitude);
  at.position += pose_gain_ * moved;
  at.velocity += rate_gain_ * moved;
  at.unexplained += acceleration_gain_ * moved;
  at.attitude = (at.attitude * rotation_of(pose_gain_ * turned)).normalized();
  at.rate += rate_gain_ * turned;
  at.unexplained_angular += acceleration_gain_ * turned;
  if (!measured.has_rates) return;
  at.velocity = measured.velocity;
  at.rate = measured.angular_velocity;
}

}  // namespace tenon::flight
