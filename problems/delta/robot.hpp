// A delta robot: three arms of two links each between a fixed base and a wrist that only translates.
//
// Frame: z down, y radially outward in an arm's plane, x lateral; arm i is turned by 0, 120 and -120 degrees about z. SI units.
// A distal link is two parallel thin rods, so that the wrist keeps its attitude; the mass of wrist and payload is shared by the arms' tips.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon::delta {

struct Robot {
  std::string name;
  double base_radius = 0;                                         // l0, m: from the axis to a shoulder
  double proximal_length = 0;                                     // l1, m
  double distal_length = 0;                                       // l2, m
  double wrist_radius = 0;                                        // l3, m: from the wrist's centre to a joint
  double proximal_com = 0;                                        // lc1, m from the shoulder
  double distal_com = 0;                                          // lc2, m from the elbow
  double proximal_mass = 0;                                       // M1, kg
  double distal_mass = 0;                                         // M2, kg, both rods
  double wrist_mass = 0;                                          // kg, whole
  double payload = 0;                                             // kg, whole, at the wrist's centre
  double proximal_inertia = 0;                                    // J1, kg m^2 about its centre of mass, the motor's rotor in it
  double distal_inertia = 0;                                      // J2, kg m^2 transverse, about the centre of mass, both rods
  Eigen::Vector3d damping{0, 0, 0};                               // of q1, q2, q3 of every arm, N m s
  double gravity = 9.81;                                          // m/s^2
  double torque_limit = std::numeric_limits<double>::infinity();  // N m, each motor
  double stabilisation = 5;                                       // p, 1/s: closure errors of the index-1 form decay as exp(-p t)
  Eigen::Vector3d gimbal_inertia{0, 0, 0};                        // of the spherical wrist's yaw, pitch and roll, kg m^2; 0: it has none
  double gimbal_torque_limit = std::numeric_limits<double>::infinity();  // N m

  double radial_offset() const { return base_radius - wrist_radius; }  // c = l0 - l3
  double tip_mass() const { return (wrist_mass + payload) / 3; }       // M3
};

/// What is wrong with a robot, and at which key of its file.
struct RobotFault {
  std::string key, found, expected;
};

/// The first thing that makes no sense: a length or mass that is not positive, a negative damping, links that never meet. Empty key: none.
RobotFault find_fault(const Robot& robot);

}  // namespace tenon::delta
