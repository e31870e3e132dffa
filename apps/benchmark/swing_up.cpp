// cart-pole/N: cold solves of the swing-up, for five horizons. pendulum/cold: the same for the pendulum; /warm: solved again after the
// initial state has moved by up to 0.02 in each entry; /rti: one real-time iteration then, preparation and feedback in one, with the
// Gauss-Newton Hessian. Peers: Ipopt, and Newton-KKT with the sparse kind.
#include "tenon/problems/optimal_control/swing_up.hpp"

#include <random>

#include "tenon/apps/benchmark/optimal_control.hpp"
#include "tenon/apps/benchmark/timed.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

namespace {

constexpr int kHorizons[] = {50, 100, 200, 300, 1000};
constexpr int kPeerHorizon = 100;
constexpr int kPeerRuns = 5, kResolves = 1000;
constexpr double kDisturbance = 0.02;

void note_split(const SwingUp& problem, BenchmarkRun& out) {
  const Timed<SwingUp> timed(problem);
  NewtonKkt<Timed<SwingUp>, TimedKkt<KktOf<SwingUp>>> solver(timed);
  Point point = start_of(problem);
  solver.solve(point);
  point = start_of(problem);
  linear_algebra_watch.seconds = evaluation_watch.seconds = 0;
  const double elapsed = solver.solve(point).elapsed;
  out.notes.push_back(fmt::format("evaluation {:.0f} %, linear algebra {:.0f} %", 100 * evaluation_watch.seconds / elapsed,
                                  100 * linear_algebra_watch.seconds / elapsed));
}

void add_cold(std::vector<Benchmark>& rows, const std::string& name, const SwingUpProgram& program, int runs, bool with_peers) {
  rows.push_back({name, [=](BenchmarkRun& out) {
                    const SwingUp problem(program);
                    NewtonKkt<SwingUp> solver(problem);
                    time_solves(solver, start_of(problem), runs, out);
                    note_split(problem, out);
                  }});
  if (!with_peers) return;
  rows.push_back({name + "/sparse", [=](BenchmarkRun& out) {
                    const SwingUp problem(program);
                    NewtonKkt<SwingUp, SparseKkt> solver(problem);
                    time_solves(solver, start_of(problem), runs, out);
                  }});
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.name != "ipopt" || !solver.available) continue;
    rows.push_back({name + "/ipopt", [=](BenchmarkRun& out) {
                      const SwingUp problem(program);
                      time_solves(*make_solver("ipopt", problem), start_of(problem), kPeerRuns, out);
                    }});
  }
}

/// From the converged point, each time with another initial state.
void run_resolves(const SwingUpProgram& program, const Options& options, BenchmarkRun& out) {
  SwingUp problem(program);
  Point converged = start_of(problem);
  NewtonKkt<SwingUp>(problem).solve(converged);
  NewtonKkt<SwingUp> solver(problem, options);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> disturbance(-kDisturbance, kDisturbance);
  Point point = converged;
  long iterations = 0;
  for (int run = 0; run < kResolves; ++run) {
    SwingUpProgram::State initial = program.initial;
    for (double& entry : initial) entry += disturbance(random);
    problem.set_initial_state(initial);
    point = converged;
    time_each(1, out, [&](int) { iterations += solver.solve(point).iterations; });
  }
  out.notes.push_back(fmt::format("{:.2f} iterations", static_cast<double>(iterations) / kResolves));
}

}  // namespace

void add_swing_up(std::vector<Benchmark>& rows) {
  for (const int intervals : kHorizons) {
    add_cold(rows, fmt::format("cart-pole/{}", intervals), cart_pole(intervals), intervals > 300 ? 5 : 50, intervals == kPeerHorizon);
  }
  add_cold(rows, "pendulum/cold", pendulum(), 500, true);
  rows.push_back({"pendulum/warm", [](BenchmarkRun& out) { run_resolves(pendulum(), {.warm_start = true}, out); }});
  rows.push_back({"pendulum/rti", [](BenchmarkRun& out) {
                    SwingUpProgram program = pendulum();
                    program.gauss_newton = true;
                    run_resolves(program, {.max_iterations = 1, .min_iterations = 1, .warm_start = true}, out);
                  }});
}

}  // namespace tenon
