// A mode of a controlled mechanism in contact, linear about its rest: what is asked for its margins of stability.
//
//     M q'' + D_c q' + K_c q = u + f          the contact as a spring and a damper, f from outside
//     u(t) = -K q - D q'                      the inner loop: sampled, held for a period, late by a delay
#pragma once

#include <string>

#include "tenon/core/eigen.hpp"

namespace tenon {

struct LinearMode {
  std::string name;
  Eigen::MatrixXd mass;                                // M: n x n, symmetric positive definite
  Eigen::MatrixXd stiffness, damping;                  // K, D of the inner loop
  Eigen::MatrixXd contact_stiffness, contact_damping;  // K_c, D_c; 0 where nothing touches
  double period = 0;                                   // s
  double delay = 0;                                    // s, from measurement to command
};

}  // namespace tenon
