// An optimal control problem of one's own: a crane's trolley moves 1 m, the load hangs still at both ends, as fast as can be.
#include <cstdio>
#include <tenon/core/automatic_dae.hpp>
#include <tenon/mpc/planner.hpp>
#include <tenon/solvers/make_solver.hpp>

/// Trolley at x[0], load on 0.8 m of rope at the angle x[1]; the input is the trolley's acceleration.
struct Crane {
  static constexpr int kStates = 4, kAlgebraics = 0, kInputs = 1;

  template <class T>
  void equations(const tenon::DaeMode&, const std::array<T, 4>& x, const std::array<T, 0>&, const std::array<T, 1>& u,
                 std::array<T, 4>& xdot, std::array<T, 0>&) const {
    xdot = {x[2], x[3], u[0], -(9.81 * sin(x[1]) + u[0] * cos(x[1])) / 0.8};
  }
};

int main() {
  const auto crane = std::make_shared<tenon::AutomaticDae<Crane>>();
  tenon::OcpPhase phase(*crane);
  phase.intervals = 40;
  phase.duration = 2, phase.shortest = 0.5, phase.longest = 5, phase.time_weight = 1;
  phase.u.limit(0, -2, 2);
  for (int i = 0; i < 4; ++i) phase.start.fix(i, 0), phase.end.fix(i, i == 0 ? 1 : 0);

  const tenon::PlannerOutcome outcome = tenon::make_plan(
      {.name = "crane", .dae = crane, .phases = {phase}},
      [](const tenon::Nlp& problem, const tenon::Options& options) { return tenon::make_solver("newton-kkt", problem, options); });
  const double half = outcome.plan.duration() / 2;
  std::printf("%s: %.4f s; half-way at %.3f m, %.3f m/s; a step is right within %.0e\n", to_string(outcome.result.status).data(), 2 * half,
              outcome.plan.at(half).x[0], outcome.plan.at(half).x[2], outcome.error.worst);
  return succeeded(outcome.result.status) ? 0 : 1;
}
