#include "tenon/problems/allocation/vehicle.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tenon/problems/allocation/throttle_map.hpp"
#include "tenon/problems/allocation/vehicle_error.hpp"

namespace tenon {

namespace {

constexpr double kUnitLengthTolerance = 1e-5;  // the rounding of published tables
constexpr double kRounding = 4e-16;
constexpr double kParallelTolerance = 1e-6;  // sine of the angle between axis and zero below which an arm turns to no effect

void normalise_direction(Eigen::Vector3d& direction, int rotor, const std::string& key, std::vector<std::string>& notes) {
  const double length = direction.norm();
  if (!std::isfinite(length)) throw VehicleError(rotor, key, key + " is not finite", "three finite numbers");
  if (length == 0) throw VehicleError(rotor, key, key + " is zero", "a direction");
  if (std::abs(length - 1) > kUnitLengthTolerance) {
    notes.push_back(fmt::format("rotor {}: {} has length {:.6g}, brought to 1", rotor + 1, key, length));
  }
  if (std::abs(length - 1) > kRounding) direction /= length;  // so that what was brought to 1 once stays as it is, bit for bit
}

void check_interval(double lower, double upper, int rotor, const std::string& key) {
  if (!(lower < upper))
    throw VehicleError(rotor, key, fmt::format("{} is [{}, {}]", key, lower, upper), "a lower value before a higher one");
}

void check_polynomial(const std::vector<double>& coefficients, int rotor, const std::string& key) {
  if (coefficients.empty()) throw VehicleError(rotor, key, key + " has no coefficients", "ascending coefficients of a polynomial");
  for (const double c : coefficients) {
    if (!std::isfinite(c)) throw VehicleError(rotor, key, fmt::format("{} has the coefficient {}", key, c), "finite coefficients");
  }
}

void normalise_rotor(Rotor& rotor, int i, std::vector<std::string>& notes) {
  if (!rotor.position.allFinite()) throw VehicleError(i, "position", "position is not finite", "three finite numbers");
  normalise_direction(rotor.axis, i, "axis", notes);
  normalise_direction(rotor.zero, i, "zero", notes);
  if (rotor.tilt && rotor.axis.cross(rotor.zero).norm() < kParallelTolerance) {
    throw VehicleError(i, "zero", "zero is parallel to axis, so that the arm turns to no effect",
                       "a thrust across the axis, or tilt = false");
  }
  if (rotor.spin != 1 && rotor.spin != -1) throw VehicleError(i, "spin", fmt::format("spin is {}", rotor.spin), "1 or -1");
  check_polynomial(rotor.thrust, i, "thrust");
  check_polynomial(rotor.torque, i, "torque");
  check_interval(rotor.throttle_lower, rotor.throttle_upper, i, "throttle");
  if (!std::isfinite(rotor.throttle_lower) || !std::isfinite(rotor.throttle_upper)) {
    throw VehicleError(i, "throttle", "throttle has no limit", "two finite limits");
  }
  check_interval(rotor.angle_lower, rotor.angle_upper, i, "angle");
  if (!(rotor.angle_rate_limit > 0)) {
    throw VehicleError(i, "angle_rate_limit", fmt::format("angle_rate_limit is {} rad/s", rotor.angle_rate_limit), "more than 0");
  }
  if (std::isnan(rotor.fails_at)) throw VehicleError(i, "fails_at", "fails_at is not a number", "a time");
  if (std::isnan(rotor.servo_sticks_at)) throw VehicleError(i, "servo_sticks_at", "servo_sticks_at is not a number", "a time");

  const double weakest = throttle_map(rotor.thrust, rotor.throttle_lower), strongest = throttle_map(rotor.thrust, rotor.throttle_upper);
  if (!(strongest > weakest)) {
    throw VehicleError(i, "thrust",
                       fmt::format("thrust is {:.6g} N at the lowest throttle and {:.6g} N at the highest", weakest, strongest),
                       "a thrust that rises");
  }
  if (!rises(rotor.thrust, rotor.throttle_lower, rotor.throttle_upper)) {
    notes.push_back(fmt::format("rotor {}: thrust falls somewhere between throttle {:.3g} and {:.3g}", i + 1, rotor.throttle_lower,
                                rotor.throttle_upper));
  }
}

void check_weights(const AllocationWeights& weights) {
  const auto check = [](double weight, const std::string& key, bool may_be_zero) {
    if (may_be_zero ? !(weight >= 0) : !(weight > 0)) {
      throw VehicleError(-1, "weights", fmt::format("weights.{} is {}", key, weight), may_be_zero ? "0 or more" : "more than 0");
    }
  };
  check(weights.throttle, "throttle", true);
  check(weights.throttle_penalty, "throttle_penalty", true);
  check(weights.angle_rate, "angle_rate", true);
  check(weights.angle_rate_penalty, "angle_rate_penalty", true);
  check(weights.angle_rate_soft, "angle_rate_soft", true);
  check(weights.force_error, "force_error", false);
  check(weights.torque_error, "torque_error", false);
  if (!(weights.throttle_soft_lower < weights.throttle_soft_upper)) {
    throw VehicleError(-1, "weights",
                       fmt::format("weights.throttle_soft_lower is {}, weights.throttle_soft_upper {}", weights.throttle_soft_lower,
                                   weights.throttle_soft_upper),
                       "a lower value before a higher one");
  }
}

}  // namespace

std::vector<std::string> normalise(Vehicle& vehicle) {
  if (vehicle.num_rotors() < kMinRotors || vehicle.num_rotors() > kMaxRotors) {
    throw VehicleError(-1, "rotor", fmt::format("there are {} rotors", vehicle.num_rotors()),
                       fmt::format("{} to {}", kMinRotors, kMaxRotors));
  }
  if (!(vehicle.mass > 0) || !std::isfinite(vehicle.mass)) {
    throw VehicleError(-1, "mass", fmt::format("mass is {} kg", vehicle.mass), "more than 0");
  }
  if (!vehicle.inertia.allFinite() || !(vehicle.inertia.minCoeff() >= 0)) {
    throw VehicleError(-1, "inertia",
                       fmt::format("inertia is [{}, {}, {}] kg m^2", vehicle.inertia[0], vehicle.inertia[1], vehicle.inertia[2]),
                       "three numbers, 0 or more");
  }
  if (!std::isfinite(vehicle.gravity) || vehicle.gravity < 0) {
    throw VehicleError(-1, "gravity", fmt::format("gravity is {} m/s^2", vehicle.gravity), "0 or more");
  }
  check_weights(vehicle.weights);
  std::vector<std::string> notes;
  for (int i = 0; i < vehicle.num_rotors(); ++i) normalise_rotor(vehicle.rotors[static_cast<std::size_t>(i)], i, notes);
  return notes;
}

}  // namespace tenon
