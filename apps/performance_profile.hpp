// Performance profiles: which share of a set of problems a solver solves within a factor of the best.
//
//     r(p, s) = cost(p, s) / min over s of cost(p, s),  infinite where s does not solve p          rho_s(tau) = |{p : r(p, s) <= tau}| / |{p}|
//
// rho_s(1) is how often s is best, and the right end of the curve how many it solves at all.
// Source: E. D. Dolan, J. J. More, Benchmarking optimization software with performance profiles, Math. Program. 91 (2002).
#pragma once

#include <string>
#include <vector>

namespace tenon {

struct PerformanceProfile {
  std::vector<std::string> solvers;
  std::vector<double> ratios;               // tau, ascending from 1: every value at which some curve steps
  std::vector<std::vector<double>> shares;  // shares[s][k] = rho_s(ratios[k])
};

/// cost[p][s] > 0, infinite where solver s does not solve problem p. Throws std::invalid_argument where there is no problem.
PerformanceProfile performance_profile(const std::vector<std::string>& solvers, const std::vector<std::vector<double>>& cost);

}  // namespace tenon
