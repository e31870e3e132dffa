// A few smooth functions f(z) of a few variables, with exact derivatives: the costs, rows and resets of an optimal control problem.
//
// Dense, since each of them sees one instant only. Automatic derivatives: automatic_function.hpp; tracking: weighted_squares.hpp.
#pragma once

#include <string>

#include "tenon/core/eigen.hpp"

namespace tenon {

class SmoothFunction {
 public:
  using Matrix = Eigen::Ref<Eigen::MatrixXd>;

  virtual ~SmoothFunction() = default;

  virtual int num_arguments() const = 0;  // n
  virtual int num_values() const = 0;     // m

  /// Outputs arrive unset and every entry is written (of the Hessian those on and below the diagonal). Evaluations allocate nothing; a
  /// non-finite value says "cannot evaluate here".
  virtual void values(ConstVectorRef z, VectorRef f) const = 0;                              // m
  virtual void jacobian(ConstVectorRef z, Matrix jacobian) const = 0;                        // m x n
  virtual void hessian(ConstVectorRef z, ConstVectorRef weights, Matrix hessian) const = 0;  // n x n, of weights' f

  virtual std::string value_name(int k) const { return std::to_string(k + 1); }
};

}  // namespace tenon
