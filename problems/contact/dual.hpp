// Numbers that carry their derivatives with respect to N variables, by Eigen's AutoDiff module.
#pragma once

// clang-format off: the alignment in core/eigen.hpp must stand before any header of Eigen
#include <unsupported/Eigen/AutoDiff>

#include "tenon/core/eigen.hpp"
// clang-format on

namespace tenon::contact {

template <int N>
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, N, 1>>;

}  // namespace tenon::contact
