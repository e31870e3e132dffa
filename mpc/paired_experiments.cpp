#include "tenon/mpc/paired_experiments.hpp"

#include <algorithm>
#include <stdexcept>

namespace tenon {

PairedExperiments::PairedExperiments(std::vector<Named> experiments) : experiments_(std::move(experiments)) {
  if (experiments_.empty()) throw std::invalid_argument("no experiment to run");
  for (std::size_t i = 0; i < experiments_.size(); ++i) {
    const std::vector<std::string> names = experiments_[i].second->names();
    const auto success = std::find(names.begin(), names.end(), "success");
    if (success == names.end()) throw std::invalid_argument("an experiment without a column 'success'");
    rows_.emplace_back(static_cast<int>(names.size()));
    drawn_.push_back(i == 0 ? 0 : static_cast<int>(success - names.begin()));
    const std::string prefix = i == 0 ? "" : experiments_[i].first + ".";
    for (auto name = names.begin() + drawn_.back(); name != names.end(); ++name) names_.push_back(prefix + *name);
  }
}

void PairedExperiments::run(std::uint64_t seed, VectorRef row) {
  int at = 0;
  for (std::size_t i = 0; i < experiments_.size(); ++i) {
    experiments_[i].second->run(seed, rows_[i]);
    const auto outcome = rows_[i].tail(rows_[i].size() - drawn_[i]);
    row.segment(at, outcome.size()) = outcome;
    at += static_cast<int>(outcome.size());
  }
}

}  // namespace tenon
