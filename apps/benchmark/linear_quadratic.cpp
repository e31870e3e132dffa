// lq/NXxNUxN: cold solves of the chain of masses with boxed inputs, kernels of constant size; the sparse kind as a peer.
#include "tenon/problems/optimal_control/linear_quadratic.hpp"

#include "tenon/apps/benchmark/optimal_control.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

namespace {

constexpr int kRuns = 500, kPeerRuns = 20;

template <int States, int Inputs>
void add(std::vector<Benchmark>& rows, int intervals) {
  using Chain = LinearQuadratic<States, Inputs>;
  const std::string name = fmt::format("lq/{}x{}x{}", States, Inputs, intervals);
  rows.push_back({name, [=](BenchmarkRun& out) {
                    const Chain problem(mass_spring_chain(States, Inputs, intervals));
                    NewtonKkt<Chain> solver(problem);
                    time_solves(solver, start_of(problem), kRuns, out);
                  }});
  rows.push_back({name + "/sparse", [=](BenchmarkRun& out) {
                    const LinearQuadratic<Dynamic, Dynamic> problem(mass_spring_chain(States, Inputs, intervals));
                    NewtonKkt<LinearQuadratic<Dynamic, Dynamic>, SparseKkt> solver(problem);
                    time_solves(solver, start_of(problem), kPeerRuns, out);
                  }});
}

}  // namespace

void add_linear_quadratic(std::vector<Benchmark>& rows) {
  add<6, 3>(rows, 20);
  add<12, 6>(rows, 20);
  add<24, 3>(rows, 50);
}

}  // namespace tenon
