// The spherical wrist: three direct-drive gimbals, yaw about z, pitch about the new y, roll about the newest x, each with its own inertia.
//
//     T = (1/2) [ (J1 + J2 + J3) a'^2 + (J2 + J3) b'^2 + J3 c'^2 - 2 J3 sin b a' c' ]        a yaw, b pitch, c roll; all balanced
//
// so that gravity and the wrist's translation do not act on it.                                                  (delta.md, section 10)
#pragma once

#include <cmath>

#include "tenon/core/eigen.hpp"

namespace tenon::delta {

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
    return mass(angle).llt().solve(torque - coriolis(angle, rate));
  }
  double kinetic_energy(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate) const { return rate.dot(mass(angle) * rate) / 2; }
  /// The torque of feedback linearisation: angle'' = w.
  Eigen::Vector3d linearising_torque(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate, const Eigen::Vector3d& w) const {
    return mass(angle) * w + coriolis(angle, rate);
  }
  /// R: tool to world, Rz(a) Ry(b) Rx(c).
  static Eigen::Matrix3d attitude(const Eigen::Vector3d& angle) {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    return (AngleAxisd(angle[0], Vector3d::UnitZ()) * AngleAxisd(angle[1], Vector3d::UnitY()) * AngleAxisd(angle[2], Vector3d::UnitX()))
        .toRotationMatrix();
  }
};

}  // namespace tenon::delta
