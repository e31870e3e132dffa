// What passes between the plant, the estimator and whoever commands, in SI: the order of measurements, commands and estimates.
//
// Theta, not phi: angles are rad here, moments N m.
#pragma once

#include <array>

#include "tenon/core/eigen.hpp"

namespace tenon::peg {

/// Of the peg's bottom centre, then the contact force on it as a filter passes it on, then the reference that the inner loop follows now.
inline constexpr int kMeasuredPose = 0, kMeasuredVelocity = 3, kMeasuredForce = 6, kMeasuredReference = 9, kMeasuredRate = 12,
                     kMeasurements = 15;
inline constexpr std::array<const char*, kMeasurements> kMeasurementNames{"x",  "z",  "theta", "vx", "vz", "omega",  "Fx",     "Fz",
                                                                          "My", "rx", "rz",    "rt", "ux", "uz", "ut"};

/// The reference at this instant, the rate at which it goes on, and the stiffness that draws the peg to it (N/m, N/m, N m/rad).
inline constexpr int kReference = 0, kReferenceRate = 3, kStiffness = 6, kCommands = 9;
inline constexpr std::array<const char*, kCommands> kCommandNames{"reference_x",      "reference_z",          "reference_theta",
                                                                  "reference_rate_x", "reference_rate_z",     "reference_rate_theta",
                                                                  "stiffness_x",      "stiffness_z",          "stiffness_theta"};

/// The pose of the hole's mouth.
inline constexpr int kEstimates = 3;
inline constexpr std::array<const char*, kEstimates> kEstimateNames{"hole_x", "hole_z", "hole_theta"};

/// m, m, rad to mm, mm, mm of phi; with a lever of mm.
inline Eigen::Vector3d to_millimetres(const Eigen::Vector3d& si, double lever) {
  return {1e3 * si[0], 1e3 * si[1], lever * si[2]};
}
inline Eigen::Vector3d to_si(const Eigen::Vector3d& millimetres, double lever) {
  return {1e-3 * millimetres[0], 1e-3 * millimetres[1], millimetres[2] / lever};
}

/// N/m, N/m, N m/rad to N/mm of (x, z, phi), and back; with a lever of mm.
inline Eigen::Vector3d stiffness_to_millimetres(const Eigen::Vector3d& si, double lever) {
  return {1e-3 * si[0], 1e-3 * si[1], 1e3 * si[2] / (lever * lever)};
}
inline Eigen::Vector3d stiffness_to_si(const Eigen::Vector3d& per_millimetre, double lever) {
  return {1e3 * per_millimetre[0], 1e3 * per_millimetre[1], 1e-3 * per_millimetre[2] * lever * lever};
}

}  // namespace tenon::peg
