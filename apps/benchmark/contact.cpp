// Rows of contact scenes: what a simulated second, ten swings and a chain cost.
#include <fmt/format.h>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/simulation.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

namespace {

struct ContactRow {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
  double rtol;
  const char* integrator;
  bool per_simulated_second;
  int runs;
};

const std::vector<ContactRow>& contact_rows() {
  static const std::vector<ContactRow> table{
      {"ball/compliant", "bouncing-ball", {}, 1e-8, "dop853", true, 200},
      {"ball/compliant/ida", "bouncing-ball", {}, 1e-8, "ida", true, 50},
      {"ball/closed_form", "bouncing-ball-restitution", {"contact.1.rest_speed=1e-3"}, 1e-8, "dop853", true, 200},
      {"cradle/ten_swings", "cradle", {}, 1e-10, "dop853", false, 50},
      {"cradle/ten_swings/ida", "cradle", {}, 1e-10, "ida", false, 10},
      {"chain/50", "rope-sway", {"beads=50"}, 1e-8, "dop853", true, 10},
      {"chain/100", "rope-sway", {"beads=100"}, 1e-8, "dop853", true, 10},
      {"chain/200", "rope-sway", {"beads=200"}, 1e-8, "dop853", true, 5},
      {"chain/100/ida", "rope-sway", {"beads=100"}, 1e-8, "ida", true, 3},
      {"chain/fountain", "chain-fountain", {}, 1e-6, "dop853", true, 3},
  };
  return table;
}

void run_row(const ContactRow& row, BenchmarkRun& run) {
  const Simulation simulation = open_simulation(row.scene, row.overrides);
  const IntegratorOptions options{.rtol = row.rtol, .atol = 1e-2 * row.rtol};
  IntegrationResult result;
  time_each(row.runs, run, [&](int) {
    DaeState state = initial_state_of(*simulation.dae);
    result = make_integrator(row.integrator, *simulation.dae, options)->advance(state, simulation.settings.duration);
  });
  if (row.per_simulated_second) {
    for (double& seconds : run.seconds) seconds /= simulation.settings.duration;
    run.notes.push_back("per simulated second");
  }
  run.notes.push_back(fmt::format("{} steps, {} evaluations, {} events", result.steps, result.evaluations, result.events));
  if (result.status != IntegrationStatus::reached) run.notes.push_back(result.explanation);
}

}  // namespace

void add_contact(std::vector<Benchmark>& rows) {
  for (const ContactRow& row : contact_rows()) {
    rows.push_back({row.name, [row](BenchmarkRun& run) { run_row(row, run); }});
  }
}

}  // namespace tenon
