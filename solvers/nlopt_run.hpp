// One run of NLopt over `const Nlp&`, by its C interface: what goes in, what comes out, and no judgement. nlopt.cpp judges.
//
//     equality rows   c(x) - c_lower  = 0            each finite side of the others   c(x) - c_upper <= 0,   c_lower - c(x) <= 0
#pragma once

#include <string>

#include "tenon/core/options.hpp"
#include "tenon/core/point.hpp"

namespace tenon {

enum class NloptMethod { slsqp, mma, ccsaq, auglag };

enum class NloptEnd {
  no_progress,  // small steps, rounding, or a subproblem that failed
  evaluations,  // Options::max_iterations of them
  time,         // Options::time_limit
  unbounded,    // the objective fell below kNloptUnbounded
  observer,     // Options::on_iteration said so
  not_finite,   // a Jacobian was not finite where objective and rows were
};

inline constexpr double kNloptUnbounded = -1e20;

struct NloptRun {
  NloptEnd end = NloptEnd::no_progress;
  Vector x;             // n: the lowest objective NLopt met among points feasible within tolerance; the start where none was
  Vector last_iterate;  // n: the last point whose gradient NLopt wanted
  int evaluations = 0;  // of the objective
  double elapsed = 0;   // s
};

/// Runs from `start` (n, within the bounds). What problem or observer throw comes out again after NLopt has returned.
NloptRun run_nlopt(NloptMethod method, const Nlp& problem, const Bounds& bounds, const Options& options, const Vector& start);

/// Of the library, as in "2.7.1".
std::string nlopt_library_version();

}  // namespace tenon
