// An estimation problem over a Dae: what its states, and parameters among them, have been and are, by what was measured.
//
//     x' = f(x, u + ripple) + drift,      y_k = h(x(t_k), u) + noise,      x(t_0) = mean +- deviation
//
// u is what was commanded, held from measurement to measurement; its ripple is drawn anew for each interval.
//
// A parameter is a state with x' = 0. All noise is Gaussian and independent, entry by entry; of what is positive (a mass, a friction) the
// logarithm is, since that is known in proportion. It knows neither transcription nor solver: mpc makes a moving horizon of it. To optimal
// control it is what core/ocp.hpp is, looking back.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/dae.hpp"
#include "tenon/core/options.hpp"
#include "tenon/core/smooth_function.hpp"

namespace tenon {

struct EstimationProblem {
  /// Of these sizes, nothing drifts, nothing is positive; what was known before is for the caller to say.
  EstimationProblem(std::shared_ptr<const Dae> dae, std::shared_ptr<const SmoothFunction> measured);

  std::string name = "estimation";
  std::shared_ptr<const Dae> dae;  // F = xdot - f(x, u): without algebraic variables, with `derivatives`
  DaeMode mode;
  std::shared_ptr<const SmoothFunction> measured;  // h(x, u)
  Vector noise;                                    // of h: standard deviations, > 0
  Vector mean, deviation;                          // of x before anything was measured; deviation > 0
  std::vector<bool> is_positive;                   // of x: `mean` is then its median, deviation/mean the deviation of its logarithm
  Vector ripple;                                   // of u: standard deviations, >= 0
  Vector drift;  // of x: the standard deviation of what comes to it in 1 s, >= 0; of what is positive: at its mean

  int window = 10;             // intervals between measurements that are looked back over, >= 1
  double longest_step = 5e-3;  // s, of the integration of f
  Options solve;               // how a window is solved: from the one before, and in deviations, which needs no scaling
};

/// Throws std::invalid_argument, naming the part, where sizes do not fit or a number makes no sense.
void validate(const EstimationProblem& problem);

}  // namespace tenon
