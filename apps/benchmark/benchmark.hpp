// Benchmark rows: what `tenon bench` runs. A row fills a list of times; median and p99 are taken of it.
//
// To add rows: a function in a .cpp of its own that appends them, called in benchmarks() of registry.cpp. A peer measured in the same run
// carries its name as the last part of the row's name, as in cart-pole/100/ipopt.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace tenon {

struct BenchmarkRun {
  std::vector<double> seconds;     // one for each run
  std::vector<std::string> notes;  // what else is worth knowing: "residual at most 1e-9", "2.1 iterations"
};

struct Benchmark {
  std::string name;
  std::function<void(BenchmarkRun&)> run;
};

/// Every row, in the order in which they run.
std::vector<Benchmark> benchmarks();

/// Calls f(k) for k = 0 .. count-1, each timed on its own.
template <class Function>
void time_each(int count, BenchmarkRun& run, Function&& f) {
  using Clock = std::chrono::steady_clock;
  run.seconds.reserve(run.seconds.size() + static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const auto start = Clock::now();
    f(k);
    run.seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
}

}  // namespace tenon
