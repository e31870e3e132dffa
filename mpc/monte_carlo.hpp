// Many runs of one experiment, on several threads.
//
// Rows come in the order in which they are done, on the thread that called; what a row holds depends on its seed alone (core/experiment.hpp).
#pragma once

#include <functional>
#include <span>

#include "tenon/core/experiment.hpp"

namespace tenon {

struct MonteCarloHandlers {
  std::function<void(std::uint64_t seed, const Vector& row)> on_row;
  std::function<bool()> go_on = nullptr;  // asked about every 5 ms; false: the runs under way are finished and reported, no new one begins
};

/// Runs every seed once. An experiment that throws ends the whole, with its exception. Throws std::invalid_argument where threads < 1.
void run_samples(const ExperimentFactory& make_experiment, std::span<const std::uint64_t> seeds, int threads, const MonteCarloHandlers& handlers);

}  // namespace tenon
