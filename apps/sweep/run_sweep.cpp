#include "tenon/apps/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/sweep/open_experiment.hpp"
#include "tenon/apps/sweep/run_margins.hpp"
#include "tenon/apps/sweep/sweep_record.hpp"
#include "tenon/apps/sweep/sweep_summary.hpp"
#include "tenon/mpc/monte_carlo.hpp"

namespace tenon {

namespace {

/// What rows of an earlier run must have in common with this one.
std::string identity(const Arguments& arguments) {
  Json overrides = Json::array();
  for (const std::string& set : arguments.set) overrides.push(set);
  return Json::object()
      .set("schema", 1)
      .set("scene", arguments.names.front())
      .set("set", overrides)
      .set("solver", arguments.solver.value_or(""))
      .set("max_iterations", arguments.max_iterations.value_or(-1))
      .set("baselines", arguments.baselines)
      .text();
}

std::vector<std::uint64_t> missing_seeds(const Arguments& arguments, const std::map<std::uint64_t, Vector>& rows) {
  std::vector<std::uint64_t> seeds;
  for (int k = 0; k < arguments.samples; ++k) {
    const std::uint64_t seed = arguments.seed + static_cast<std::uint64_t>(k);
    if (!rows.contains(seed)) seeds.push_back(seed);
  }
  return seeds;
}

/// Every size()-th of them, beginning with the rank-th.
std::vector<std::uint64_t> share_of(const Crew& crew, const std::vector<std::uint64_t>& seeds) {
  std::vector<std::uint64_t> share;
  for (std::size_t k = static_cast<std::size_t>(crew.rank()); k < seeds.size(); k += static_cast<std::size_t>(crew.size())) share.push_back(seeds[k]);
  return share;
}

void work(const Arguments& arguments, Crew& crew, const ExperimentFactory& make_experiment) {
  std::vector<std::uint64_t> seeds;
  crew.share(seeds);
  run_samples(make_experiment, share_of(crew, seeds), arguments.threads,
              {.on_row = [&](std::uint64_t seed, const Vector& row) { crew.send(seed, row); }, .go_on = [] { return !interrupted(); }});
  crew.leave();
}

int lead(const Arguments& arguments, Crew& crew, const ExperimentFactory& make_experiment) {
  const std::unique_ptr<Experiment> experiment = make_experiment();
  const std::string path = arguments.output.empty() ? record_beside_report(arguments, ".csv", "") : arguments.output;
  SweepRecord record(path, experiment->names(), identity(arguments), arguments.resume);
  std::vector<std::uint64_t> seeds = missing_seeds(arguments, record.rows());
  const std::size_t expected = record.rows().size() + seeds.size();
  crew.share(seeds);
  {
    Progress progress("sweep", arguments.samples, arguments.quiet);
    const auto add = [&](std::uint64_t seed, const Vector& row) {
      record.add(seed, row);
      progress.update(static_cast<long>(record.rows().size()));
    };
    const auto receive = [&] {
      std::uint64_t seed = 0;
      for (Vector row(static_cast<int>(record.names().size())); crew.receive(seed, row);) add(seed, row);
      return !interrupted();
    };
    run_samples(make_experiment, share_of(crew, seeds), arguments.threads, {.on_row = add, .go_on = receive});
    while (!crew.is_alone()) receive(), std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (record.rows().size() < expected) {
    if (!path.empty()) fmt::print(stderr, "tenon: interrupted, {} rows are in {}; --resume goes on\n", record.rows().size(), record.partial_path());
    return kInterrupted;
  }
  record.finish();
  make_report(arguments, {path});
  const SweepSummary summary(arguments.names.front(), record.names(), experiment->severity(), record.rows());
  if (arguments.json)
    print(summary.json().set("processes", crew.size()));
  else if (!arguments.quiet)
    fmt::print(path == "-" ? stderr : stdout, "{}", summary.text());
  return kFinished;
}

}  // namespace

Verb sweep_verb(int (*run)(const Arguments&)) {
  return {"sweep",
          "a scene's closed loop in many worlds drawn from its [uncertainty]",
          "SCENE",
          1,
          1,
          {"samples", "baselines", "margins", "threads", "resume", "output", "report", "solver", "set", "max-iterations", "seed", "json", "quiet"},
          run};
}

int sweep(const Arguments& arguments, Crew& crew, const SolverFactory& make_solver) {
  if (arguments.margins) return crew.is_first() ? run_margins(arguments, make_solver) : kFinished;
  if (arguments.samples < 1) throw std::invalid_argument("sweep: no samples (expected --samples N, at least 1)");
  if (arguments.resume && arguments.output.empty()) throw std::invalid_argument("--resume: no record to go on with (expected --output FILE.csv too)");
  check_report(arguments);
  const ExperimentFactory make_experiment = open_experiment(arguments, make_solver);
  if (crew.is_first()) return lead(arguments, crew, make_experiment);
  work(arguments, crew, make_experiment);
  return kFinished;
}

}  // namespace tenon
