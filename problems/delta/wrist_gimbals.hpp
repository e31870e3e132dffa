// The spherical wrist: three direct-drive gimbals, yaw about z, pitch about the new y, roll about the newest x, each with its own inertia.
//
//     T = (1/2) [ (J1 + J2 + J3) a'^2 + (J2 + J3) b'^2 + J3 c'^2 - 2 J3 sin b a' c' ]        a yaw, b pitch, c roll; all balanced
//
// so that gravity and the wrist's translation do not act on it.                                                  (delta.md, section 10)
#pragma once

#include <cmath>

#include "tenon/core/eigen.hpp"
#include "tenon/problems/allocation/lane_trigonometry.hpp"

namespace tenon::delta {

/// Where the gimbals' angles turn the tool.
struct GimbalFrame {
  Eigen::Matrix3d attitude;  // R: tool to world, Rz(a) Ry(b) Rx(c)
  Eigen::Matrix3d axes;      // of yaw, pitch and roll in world axes, as columns: angular velocity = axes rate

  explicit GimbalFrame(const Eigen::Vector3d& angle) {
    Eigen::Array3d sine, cosine;
    sine_and_cosine<double, 3>(angle.array(), sine, cosine);
    const double ca = cosine[0], cb = cosine[1], cc = cosine[2], sa = sine[0], sb = sine[1], sc = sine[2];
    axes << 0, -sa, ca * cb,  //
        0, ca, sa * cb,       //
        1, 0, -sb;
    attitude.col(0) = axes.col(2);
    attitude.col(1) = cc * axes.col(1) + sc * Eigen::Vector3d(ca * sb, sa * sb, cb);
    attitude.col(2) = attitude.col(0).cross(attitude.col(1));
  }
};

struct WristGimbals {
  Eigen::Vector3d inertia{0, 0, 0};  // J1, J2, J3: yaw, pitch, roll, kg m^2

  Eigen::Matrix3d mass(const Eigen::Vector3d& angle) const {
    const double coupling = -inertia[2] * std::sin(angle[1]);
    Eigen::Matrix3d m = Eigen::Vector3d(inertia.sum(), inertia[1] + inertia[2], inertia[2]).asDiagonal();
    m(0, 2) = m(2, 0) = coupling;
    return m;
  }
  /// Coriolis and gyroscopic torques.
  Eigen::Vector3d coriolis(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate) const {
    return inertia[2] * std::cos(angle[1]) * Eigen::Vector3d(-rate[1] * rate[2], rate[0] * rate[2], -rate[0] * rate[1]);
  }
  Eigen::Vector3d acceleration(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate, const Eigen::Vector3d& torque) const {
    const Eigen::Matrix3d m = mass(angle);
    const Eigen::Vector3d r = torque - coriolis(angle, rate);
    const double det = m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2);
    return {(m(2, 2) * r[0] - m(0, 2) * r[2]) / det, r[1] / m(1, 1), (m(0, 0) * r[2] - m(0, 2) * r[0]) / det};
  }
  double kinetic_energy(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate) const { return rate.dot(mass(angle) * rate) / 2; }
  /// The torque of feedback linearisation: angle'' = w.
  Eigen::Vector3d linearising_torque(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate, const Eigen::Vector3d& w) const {
    return mass(angle) * w + coriolis(angle, rate);
  }
};

}  // namespace tenon::delta
