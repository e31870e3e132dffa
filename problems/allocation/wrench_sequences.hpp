// Wrenches of our own making, in body axes: what tests, comparisons and benchmarks allocate.
//
// The numbers drawn are the same on every machine: a generator with a fixed sequence, and distributions that no library chooses for us.
#pragma once

#include <cstdint>
#include <vector>

#include "tenon/core/random.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

inline constexpr double kSequenceStep = 1.0 / 240;  // s, from row to row

class RandomNumbers : public Random {
 public:
  using Random::Random;

  /// Uniform on the unit sphere, and in a ball.
  Eigen::Vector3d direction();
  Eigen::Vector3d in_ball(double radius);
  /// Uniform over all orientations.
  Eigen::Quaterniond orientation();
};

/// Hovering in all orientations: the weight, as the body turns under it. Once round each of three great circles through two arm axes (the
/// first rotor's, the one nearest to a right angle with it, and their normal), then a spiral over the whole sphere. On momav gravity passes
/// along each arm axis, either way, twice at speed, where that pair of arms has no thrust and its angles are undefined. Level to level.
std::vector<Wrench> hover_sweep(const Vehicle& vehicle, int rows = 14400);

/// White noise on each component (standard deviations in N and N m).
std::vector<Wrench> with_noise(std::vector<Wrench> wrenches, double force, double torque, std::uint64_t seed);

/// The body turns at random (0.01 rad a row and axis); force and torque beside the weight walk within 10 N and 1.5 N m.
std::vector<Wrench> random_walk(const Vehicle& vehicle, int rows, std::uint64_t seed);

/// One tick on its own: orientation uniform, |F - weight| <= 10 N, |M| <= 1.5 N m; the arms up to 0.2 rad from the linear solution.
struct RandomRow {
  Wrench wrench;
  Vector previous;   // N angles, rad
  Vector throttle;   // N: the linear solution
  Vector angle;      // N, rad
};
std::vector<RandomRow> random_rows(const Vehicle& vehicle, int rows, std::uint64_t seed);

}  // namespace tenon
