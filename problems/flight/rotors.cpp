#include "tenon/problems/flight/rotors.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "tenon/problems/allocation/throttle_map.hpp"

namespace tenon::flight {

Rotors::Rotors(const Vehicle& vehicle) {
  for (const Rotor& rotor : vehicle.rotors) {
    Plane plane;
    plane.thrust = rotor.thrust;
    plane.drag = rotor.torque;
    const Eigen::Vector3d p0 = rotor.axis.dot(rotor.zero) * rotor.axis;
    const Eigen::Vector3d p[] = {p0, rotor.zero - p0, rotor.axis.cross(rotor.zero)};
    for (int k = 0; k < 3; ++k) {
      plane.force[k] << p[k], rotor.position.cross(p[k]);
      plane.torque[k] << Eigen::Vector3d::Zero(), rotor.spin * p[k];
    }
    rotors_.push_back(plane);
  }
}

Wrench Rotors::wrench(ConstVectorRef u, ConstVectorRef a) const {
  Wrench sum = Wrench::Zero();
  for (int i = 0; i < size(); ++i) {
    const Plane& r = rotors_[static_cast<std::size_t>(i)];
    const double thrust = throttle_map(r.thrust, u[i]), drag = throttle_map(r.drag, u[i]), c = std::cos(a[i]), s = std::sin(a[i]);
    sum += thrust * (r.force[0] + c * r.force[1] + s * r.force[2]) + drag * (r.torque[0] + c * r.torque[1] + s * r.torque[2]);
  }
  return sum;
}

void Rotors::jacobian(ConstVectorRef u, ConstVectorRef a, Eigen::Ref<Eigen::MatrixXd> by_u, Eigen::Ref<Eigen::MatrixXd> by_a) const {
  for (int i = 0; i < size(); ++i) {
    const Plane& r = rotors_[static_cast<std::size_t>(i)];
    const double c = std::cos(a[i]), s = std::sin(a[i]);
    by_u.col(i) = throttle_map_slope(r.thrust, u[i]) * (r.force[0] + c * r.force[1] + s * r.force[2]) +
                  throttle_map_slope(r.drag, u[i]) * (r.torque[0] + c * r.torque[1] + s * r.torque[2]);
    by_a.col(i) = throttle_map(r.thrust, u[i]) * (c * r.force[2] - s * r.force[1]) +
                  throttle_map(r.drag, u[i]) * (c * r.torque[2] - s * r.torque[1]);
  }
}

}  // namespace tenon::flight
