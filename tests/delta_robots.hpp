// Robots and configurations at random, for laws that hold for all of them.
#pragma once

#include <algorithm>
#include <random>

#include "tenon/problems/delta/dynamics.hpp"
#include "tenon/problems/delta/robot_file.hpp"

namespace tenon::delta {

/// Links, masses and inertias around those of `delta`, each by a factor between 0.6 and 1.6.
inline Robot random_robot(std::mt19937_64& random) {
  std::uniform_real_distribution<double> factor(0.6, 1.6);
  Robot robot = load_robot("delta");
  for (double Robot::*field :
       {&Robot::base_radius, &Robot::proximal_length, &Robot::wrist_radius, &Robot::proximal_com, &Robot::distal_com, &Robot::proximal_mass,
        &Robot::distal_mass, &Robot::wrist_mass, &Robot::proximal_inertia, &Robot::distal_inertia}) {
    robot.*field *= factor(random);
  }
  robot.distal_length = robot.proximal_length * (1 + factor(random));
  robot.payload = 0.2 * factor(random);
  return robot;
}

inline Robot test_robot(int k, std::mt19937_64& random) {
  return k == 0 ? load_robot("delta") : k == 1 ? load_robot("delta-demo") : random_robot(random);
}

/// A reachable configuration, clear of every singularity.
inline Vector9 random_configuration(const Robot& robot, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double reach = robot.proximal_length + robot.distal_length;
  for (;;) {
    const Vector3 z(0.5 * reach * unit(random), 0.5 * reach * unit(random), reach * (0.6 + 0.3 * unit(random)));
    const Inverse inverse = inverse_kinematics(robot, z);
    if (!inverse.ok()) continue;
    const Configuration at(inverse.q);
    const Singularity measure = Motion(robot, at).singularity(robot, at);
    if (std::min({measure.type_1, measure.type_2, measure.s2}) > 0.1) return inverse.q;
  }
}

inline Vector3 random_vector(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  return {unit(random), unit(random), unit(random)};
}

}  // namespace tenon::delta
