// How sure a success rate is: the exact binomial interval.
//
//     lower p:  P(X >= k | n, p) = a/2        upper p:  P(X <= k | n, p) = a/2        [Clopper and Pearson 1934]
//
// Of n successes in n it says p > (a/2)^(1/n): no failure in 500 leaves room for one in 136.
#pragma once

namespace tenon {

struct SuccessInterval {
  double lower = 0, upper = 1;
};

/// The interval that holds the true rate with at least this confidence; 0 to 1 where there are no samples.
SuccessInterval success_interval(int successes, int samples, double confidence = 0.95);

}  // namespace tenon
