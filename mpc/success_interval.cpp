#include "tenon/mpc/success_interval.hpp"

#include <cmath>

namespace tenon {

namespace {

/// P(X <= k) of n trials with probability p.
double cumulative(int k, int n, double p) {
  if (p <= 0) return 1;
  if (p >= 1) return k >= n ? 1 : 0;
  double sum = 0;
  for (int i = 0; i <= k; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return sum;
}

/// The p at which a falling function of it is `level`.
template <class Function>
double where(const Function& falling, double level) {
  double below = 0, above = 1;
  for (int i = 0; i < 60; ++i) {
    const double p = (below + above) / 2;
    (falling(p) > level ? below : above) = p;
  }
  return (below + above) / 2;
}

}  // namespace

SuccessInterval success_interval(int successes, int samples, double confidence) {
  const double tail = (1 - confidence) / 2;
  SuccessInterval interval;
  if (samples == 0) return interval;
  if (successes > 0) interval.lower = where([&](double p) { return cumulative(successes - 1, samples, p); }, 1 - tail);
  if (successes < samples) interval.upper = where([&](double p) { return cumulative(successes, samples, p); }, tail);
  return interval;
}

}  // namespace tenon
