// What a sweep comes to: of the controller, and of each baseline on the same seeds, how often it succeeds, how sure that is, and the spread of
// times and forces.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tenon/apps/json.hpp"
#include "tenon/core/eigen.hpp"
#include "tenon/mpc/success_interval.hpp"

namespace tenon {

class SweepSummary {
 public:
  /// Of rows as PairedExperiments names their columns; runs that failed are worse than others, then the greater `severity`.
  SweepSummary(std::string scene, const std::vector<std::string>& names, const std::string& severity, const std::map<std::uint64_t, Vector>& rows);

  Json json() const;
  std::string text() const;

 private:
  struct Spread {
    std::string column;  // without its contestant's name
    double median = 0, p95 = 0, max = 0;
  };
  struct Contestant {
    std::string name;
    int successes = 0;
    SuccessInterval interval;
    std::vector<Spread> spreads;
  };

  void set_figures(Json& json, const Contestant& contestant) const;

  std::string scene_;
  int samples_ = 0;
  std::vector<Contestant> contestants_;  // the controller first
  std::uint64_t worst_seed_ = 0;
  std::vector<std::pair<std::string, double>> worst_;
};

}  // namespace tenon
