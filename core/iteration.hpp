// One line of an iteration trace, as handed to Options::on_iteration. Printing, tracing and progress bars are observers of it.
#pragma once

namespace tenon {

struct Iteration {
  int index = 0;
  double objective = 0;        // f(x)
  double primal = 0;           // largest violation of a row or bound
  double dual = 0;             // |grad f + J' lambda + z|_inf
  double complementarity = 0;  // largest multiplier times distance to its bound
  double mu = 0;               // barrier parameter, 0 where a back end has none
  double alpha_primal = 0;     // step length that led here
  double alpha_dual = 0;
  double regularization = 0;   // added to the Hessian's diagonal to correct the inertia
  int trials = 0;              // points the line search looked at
};

}  // namespace tenon
