// What stands on the command line after the verb.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tenon/core/options.hpp"

namespace tenon {

struct Arguments {
  std::vector<std::string> names;  // the words that are no flags: problems, a vehicle, a file
  std::string wrenches, measurements, output, events, fast_phase, report, trace, dump, profile, workspace, impedance;
  std::optional<std::string> solver, solvers, initial, inverse, forward;
  std::vector<std::string> set;
  std::optional<double> tolerance, time_limit;
  std::optional<int> max_iterations;
  std::uint64_t seed = 1;
  bool seed_is_given = false;
  int rows = 0;
  int samples = 0;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  int starts = 1;
  int degree = 2;
  bool baselines = false, margins = false, resume = false;
  bool constant = false, cold = false, jacobians = false, real_time = false, json = false, quiet = false, verbose = false;

  /// The solver options that were given; the others as they are by default, or as the caller has them.
  Options options(Options options = {}) const {
    if (tolerance) options.tolerance = *tolerance;
    if (max_iterations) options.max_iterations = *max_iterations;
    if (time_limit) options.time_limit = *time_limit;
    validate(options);
    return options;
  }
};

}  // namespace tenon
