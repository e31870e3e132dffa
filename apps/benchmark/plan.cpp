// plan/NAME: cold solves of the scenes to plan, collocated on their first mesh with 3 points. plan/NAME/shooting: the same task on as many
// intervals by the Runge-Kutta program, through the same interface, which is what cart-pole/100 and pendulum/cold time without one.
#include <fmt/format.h>

#include "tenon/apps/benchmark/optimal_control.hpp"
#include "tenon/mpc/collocation.hpp"
#include "tenon/problems/optimal_control/ocp_scene.hpp"
#include "tenon/problems/optimal_control/swing_up.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr int kRuns = 20, kPeerRuns = 5, kShootingRuns = 50;

void add(std::vector<Benchmark>& rows, const std::string& name, std::shared_ptr<const Nlp> program, const std::string& solver, int runs) {
  rows.push_back({name, [=](BenchmarkRun& out) { time_solves(*make_solver(solver, *program), start_of(*program), runs, out); }});
}

}  // namespace

void add_plan(std::vector<Benchmark>& rows) {
  bool has_ipopt = false;
  for (const SolverDescription& solver : list_solvers()) has_ipopt = has_ipopt || (solver.name == "ipopt" && solver.available);
  for (const char* scene : {"bouncing-ball-catch", "cart-pole", "pendulum", "pendulum-cartesian", "push-and-slide"}) {
    const auto program = std::make_shared<Collocation>(load_ocp_scene(scene).ocp, 3);
    add(rows, fmt::format("plan/{}", scene), program, "newton-kkt", kRuns);
    if (has_ipopt) add(rows, fmt::format("plan/{}/ipopt", scene), program, "ipopt", kPeerRuns);
  }
  add(rows, "plan/cart-pole/shooting", std::make_shared<SwingUp>(cart_pole()), "newton-kkt", kShootingRuns);
  add(rows, "plan/pendulum/shooting", std::make_shared<SwingUp>(pendulum()), "newton-kkt", kShootingRuns);
}

}  // namespace tenon
