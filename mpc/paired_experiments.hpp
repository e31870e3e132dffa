// Several experiments on the same seeds, so that they are compared run by run: a controller and its baselines in the same worlds.
//
//     drawn ... , success ... of the first, NAME.success ... of each other one
#pragma once

#include <utility>
#include <vector>

#include "tenon/core/experiment.hpp"

namespace tenon {

class PairedExperiments final : public Experiment {
 public:
  using Named = std::pair<std::string, std::unique_ptr<Experiment>>;

  /// Throws std::invalid_argument where there is none, or one has no column `success`. The first one's name is not read.
  explicit PairedExperiments(std::vector<Named> experiments);

  std::vector<std::string> names() const override { return names_; }
  std::string severity() const override { return experiments_.front().second->severity(); }
  void run(std::uint64_t seed, VectorRef row) override;

 private:
  std::vector<Named> experiments_;
  std::vector<Vector> rows_;
  std::vector<int> drawn_;  // columns before `success`
  std::vector<std::string> names_;
};

}  // namespace tenon
