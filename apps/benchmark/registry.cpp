#include "tenon/apps/benchmark/benchmark.hpp"

namespace tenon {

void add_allocation(std::vector<Benchmark>& rows);
void add_contact(std::vector<Benchmark>& rows);
void add_linear_allocation(std::vector<Benchmark>& rows);

std::vector<Benchmark> benchmarks() {
  std::vector<Benchmark> rows;
  add_allocation(rows);
  add_linear_allocation(rows);
  add_contact(rows);
  return rows;
}

}  // namespace tenon
