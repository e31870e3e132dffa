// Eigen, with its alignment pinned.
//
// Fixed-size matrices appear in installed headers. Their alignment would follow the instruction set of whoever compiles, so that a
// library built with AVX and a caller built without it would disagree about the layout. 32 bytes for everybody removes the question.
#pragma once

#define EIGEN_MAX_ALIGN_BYTES 32
#define EIGEN_MAX_STATIC_ALIGN_BYTES 32

#include <Eigen/Dense>
#include <Eigen/SparseCore>

static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES == 32, "include <tenon/core/eigen.hpp> before any header of Eigen");

namespace tenon {

inline constexpr int Dynamic = Eigen::Dynamic;

using Vector = Eigen::VectorXd;
using VectorRef = Eigen::Ref<Eigen::VectorXd>;
using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

}  // namespace tenon
