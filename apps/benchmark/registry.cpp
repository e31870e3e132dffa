#include "tenon/apps/benchmark/benchmark.hpp"

namespace tenon {

void add_allocation(std::vector<Benchmark>& rows);
void add_contact(std::vector<Benchmark>& rows);
void add_delta(std::vector<Benchmark>& rows);
void add_estimate(std::vector<Benchmark>& rows);
void add_flight(std::vector<Benchmark>& rows);
void add_envelope(std::vector<Benchmark>& rows);
void add_linear_allocation(std::vector<Benchmark>& rows);
void add_linear_quadratic(std::vector<Benchmark>& rows);
void add_plan(std::vector<Benchmark>& rows);
void add_receding_horizon(std::vector<Benchmark>& rows);
void add_swing_up(std::vector<Benchmark>& rows);

std::vector<Benchmark> benchmarks() {
  std::vector<Benchmark> rows;
  add_allocation(rows);
  add_linear_allocation(rows);
  add_swing_up(rows);
  add_linear_quadratic(rows);
  add_plan(rows);
  add_contact(rows);
  add_delta(rows);
  add_flight(rows);
  add_envelope(rows);
  add_receding_horizon(rows);
  add_estimate(rows);
  return rows;
}

}  // namespace tenon
