// A run that can be repeated for any seed: what a Monte Carlo sweep does many times over, on as many workers as there are.
//
// The row depends on the seed alone, bit for bit: not on the worker, on what it ran before, or on the time of day.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

class Experiment {
 public:
  virtual ~Experiment() = default;

  /// Of the row's columns: what was drawn, then `success` (0 or 1), then what else came of it.
  virtual std::vector<std::string> names() const = 0;

  /// The column whose greatest value is the worst; of runs that fail as of those that do not, but those that fail are worse.
  virtual std::string severity() const { return {}; }

  /// One run; fills one value for each name.
  virtual void run(std::uint64_t seed, VectorRef row) = 0;
};

/// One for each worker.
using ExperimentFactory = std::function<std::unique_ptr<Experiment>()>;

}  // namespace tenon
