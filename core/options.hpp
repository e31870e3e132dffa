// What a user has a reason to turn. Constants of the algorithms stay beside their use.
#pragma once

#include <functional>
#include <limits>

#include "tenon/core/iteration.hpp"

namespace tenon {

struct Options {
  double tolerance = 1e-8;       // a solve ends when every scaled residual is at most this
  int max_iterations = 3000;
  int min_iterations = 0;        // at least so many steps, even from a start that meets the tolerance
  double time_limit = std::numeric_limits<double>::infinity();  // s
  bool warm_start = false;       // the point's lambda and z are a guess worth keeping: start near them, with a small barrier parameter

  bool scaling = true;           // let the solver scale a sparse problem: core/scaled_nlp.hpp

  double initial_mu = 0;         // first barrier parameter of an interior-point method; 0: the solver's choice

  /// Called at every iterate, the first included; return false to stop there (Status::stopped).
  std::function<bool(const Iteration&)> on_iteration = nullptr;
};

/// Throws std::invalid_argument, naming the option, where one makes no sense (tolerance <= 0, a negative limit, NaN).
void validate(const Options& options);

}  // namespace tenon
