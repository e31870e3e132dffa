// Order statistics of a sample.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tenon {

/// The value below which a share of the sample lies (0.5 the median), nearest rank; 0 for an empty sample.
inline double percentile(std::vector<double> sample, double share) {
  if (sample.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(sample.size()))) - 1;
  const auto at = sample.begin() + std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(sample) - 1);
  std::nth_element(sample.begin(), at, sample.end());
  return *at;
}

inline double median(const std::vector<double>& sample) {
  return percentile(sample, 0.5);
}

inline double mean(const std::vector<double>& sample) {
  double sum = 0;
  for (const double v : sample) sum += v;
  return sample.empty() ? 0 : sum / static_cast<double>(sample.size());
}

}  // namespace tenon
