#include "tenon/apps/performance_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tenon {

PerformanceProfile performance_profile(const std::vector<std::string>& solvers, const std::vector<std::vector<double>>& cost) {
  if (cost.empty()) throw std::invalid_argument("a performance profile of no problem (expected one or more)");
  std::vector<std::vector<double>> ratio(cost.size());
  std::vector<double> ratios = {1};
  for (std::size_t p = 0; p < cost.size(); ++p) {
    const double best = *std::min_element(cost[p].begin(), cost[p].end());
    for (const double c : cost[p]) {
      ratio[p].push_back(std::isfinite(c) ? c / best : std::numeric_limits<double>::infinity());
      if (std::isfinite(c)) ratios.push_back(c / best);
    }
  }
  std::sort(ratios.begin(), ratios.end());
  ratios.erase(std::unique(ratios.begin(), ratios.end()), ratios.end());

  PerformanceProfile profile{solvers, ratios, {}};
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    std::vector<double>& shares = profile.shares.emplace_back();
    for (const double tau : ratios) {
      const auto within = std::count_if(ratio.begin(), ratio.end(), [&](const std::vector<double>& r) { return r[s] <= tau; });
      shares.push_back(static_cast<double>(within) / static_cast<double>(cost.size()));
    }
  }
  return profile;
}

}  // namespace tenon
