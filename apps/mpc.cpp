// tenon mpc SCENE: a receding horizon against its simulated world, and the baselines in the same world beside it.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

using Clock = std::chrono::steady_clock;

/// What the steps of a run took.
struct StepStatistics {
  std::vector<double> times;  // s
  long iterations = 0, fallbacks = 0, deadline_misses = 0;

  void add(const StepLog& step, double deadline) {
    times.push_back(step.elapsed);
    iterations += step.iterations;
    fallbacks += step.fell_back() ? 1 : 0;
    deadline_misses += step.elapsed > deadline ? 1 : 0;
  }
};

/// What the flags change of how plans are solved for.
void apply(const Arguments& arguments, HorizonOptions& options) {
  options.warm = arguments.options(options.warm);
  const int cold_iterations = options.cold.max_iterations;
  options.cold = arguments.options(options.cold);
  options.cold.max_iterations = cold_iterations;  // a plan from nothing is not to be had in an iteration or two
  options.ahead.tolerance = options.cold.tolerance;
}

class MpcRun {
 public:
  MpcRun(const Arguments& arguments, ControlTask& task, Controller& controller)
      : arguments_(arguments),
        controller_(controller),
        loop_(*task.plant, controller, task.duration),
        deadline_(arguments.time_limit.value_or(controller.period())),
        progress_("mpc", std::lround(task.duration / controller.period()), arguments.quiet) {
    if (arguments.output.empty()) return;
    std::vector<std::string> columns = loop_.columns();
    columns.emplace_back("step_time");
    csv_.emplace(arguments.output, columns);
  }

  /// False where it was interrupted.
  bool run(std::uint64_t seed) {
    start_ = Clock::now();
    loop_.run(seed, [this](const Vector& row) { return tick(row); });
    if (csv_ && !interrupted()) csv_->finish();
    return !interrupted();
  }

  const StepStatistics& steps() const { return steps_; }
  std::string partial() const { return csv_ ? csv_->file().partial_path() : ""; }

 private:
  bool tick(const Vector& row) {
    const StepLog step = controller_.last_step();
    steps_.add(step, deadline_);
    if (csv_) {
      for (const double value : row) *csv_ << value;
      *csv_ << step.elapsed;
      csv_->end_row();
    }
    progress_.update(static_cast<long>(steps_.times.size()));
    if (arguments_.real_time)
      std::this_thread::sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(row[0])));
    return !interrupted();
  }

  const Arguments& arguments_;
  Controller& controller_;
  ClosedLoop loop_;
  double deadline_;
  Progress progress_;
  std::optional<CsvWriter> csv_;
  StepStatistics steps_;
  Clock::time_point start_;
};

/// One controller in the world of this seed: the verdicts on it.
struct Outcome {
  std::string controller;
  Vector verdicts;
};

Vector verdicts_of(const Plant& plant) {
  Vector verdicts(plant.num_verdicts());
  plant.verdicts(verdicts);
  return verdicts;
}

Json json_of(const Plant& plant, const Vector& verdicts) {
  Json json = Json::object();
  for (int i = 0; i < plant.num_verdicts(); ++i) json.set(plant.verdict_name(i), verdicts[i]);
  return json;
}

void print_json(const ControlTask& task, const std::string& solver, std::uint64_t seed, const StepStatistics& steps,
                const std::vector<Outcome>& outcomes) {
  Json baselines = Json::array();
  for (std::size_t k = 1; k < outcomes.size(); ++k) {
    baselines.push(Json::object().set("name", outcomes[k].controller).set("verdicts", json_of(*task.plant, outcomes[k].verdicts)));
  }
  const Json step_time = Json::object()
                             .set("median", median(steps.times))
                             .set("p99", percentile(steps.times, 0.99))
                             .set("max", percentile(steps.times, 1));
  print(Json::object()
            .set("schema", 1)
            .set("scene", task.name)
            .set("solver", solver)
            .set("seed", static_cast<long>(seed))
            .set("steps", static_cast<long>(steps.times.size()))
            .set("iterations", steps.iterations)
            .set("fallbacks", steps.fallbacks)
            .set("deadline_misses", steps.deadline_misses)
            .set("step_time", step_time)
            .set("verdicts", json_of(*task.plant, outcomes.front().verdicts))
            .set("baselines", baselines));
}

void print_text(const ControlTask& task, bool solves, std::uint64_t seed, const StepStatistics& steps, const std::vector<Outcome>& outcomes) {
  if (!solves)
    fmt::print("{}, world {}: {} steps of a script\n", task.name, seed, steps.times.size());
  else
    fmt::print("{}, world {}: {} steps, {} iterations, {} fallbacks, {} late; a step takes {} (p99 {}, most {})\n", task.name, seed,
               steps.times.size(), steps.iterations, steps.fallbacks, steps.deadline_misses, duration_text(median(steps.times)),
               duration_text(percentile(steps.times, 0.99)), duration_text(percentile(steps.times, 1)));
  std::vector<std::string> header{"controller"};
  for (int i = 0; i < task.plant->num_verdicts(); ++i) header.push_back(task.plant->verdict_name(i));
  Table table(header);
  for (const Outcome& outcome : outcomes) {
    std::vector<std::string> row{outcome.controller};
    for (const double value : outcome.verdicts) row.push_back(fmt::format("{:.4g}", value));
    table.add(row);
  }
  fmt::print("{}", table.text());
}

}  // namespace

int run_mpc(const Arguments& given) {
  Arguments arguments = given;
  check_report(arguments);
  if (arguments.output.empty()) arguments.output = record_beside_report(arguments, ".csv", "");
  ControlTask task = make_task(arguments.names.front(), arguments.set);
  apply(arguments, task.options);
  const std::string solver = arguments.solver.value_or(default_solver());
  const SolverFactory factory = [&](const Nlp& problem, const Options& options) { return make_solver(solver, problem, options); };
  const std::uint64_t seed = arguments.seed.value_or(0);

  const std::vector<std::string> names = controller_names(task);
  const bool solves = task.program != nullptr;  // or the first controller is a script
  const auto controller = take_controller(task, names.front(), factory);
  MpcRun run(arguments, task, *controller);
  if (!run.run(seed)) {
    if (!run.partial().empty()) fmt::print(stderr, "tenon: interrupted, {} rows are in {}\n", run.steps().times.size(), run.partial());
    return kInterrupted;
  }
  std::vector<Outcome> outcomes{{names.front(), verdicts_of(*task.plant)}};
  if (!arguments.output.empty()) {
    if (solves) {
      task.scenery.plots.push_back({.title = "Solver", .columns = {"iterations", "fallback"}});
      task.scenery.plots.push_back({.title = "Step time", .unit = "s", .columns = {"step_time"}});
    }
    write_scenery(task.scenery, arguments.output);
    make_report(arguments, {arguments.output});
  }
  for (std::size_t k = 1; k < names.size(); ++k) {
    const auto baseline = take_controller(task, names[k], factory);
    ClosedLoop(*task.plant, *baseline, task.duration).run(seed, [](const Vector&) { return !interrupted(); });
    if (interrupted()) return kInterrupted;
    outcomes.push_back({names[k], verdicts_of(*task.plant)});
  }
  if (arguments.json)
    print_json(task, solver, seed, run.steps(), outcomes);
  else if (!arguments.quiet)
    print_text(task, solves, seed, run.steps(), outcomes);
  return kFinished;
}

}  // namespace tenon
