// tenon plan SCENE: one trajectory by direct collocation, on a mesh refined until its error is below the scene's tolerance.
#include <fmt/format.h>

#include <algorithm>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/next_step.hpp"
#include "tenon/apps/observers.hpp"
#include "tenon/apps/plan_obstacles.hpp"
#include "tenon/apps/plan_task.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/trajectory.hpp"
#include "tenon/mpc/planner.hpp"
#include "tenon/problems/optimal_control/ocp_scene.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

constexpr int kRowsOfAnInterval = 5;

/// What a phase took: its intervals, and when it is over.
struct PhaseSummary {
  std::string name;
  int intervals = 0;
  double begin = 0, end = 0;
};

std::vector<PhaseSummary> phases_of(const OcpScene& scene, const Plan& plan) {
  std::vector<PhaseSummary> phases;
  for (const OcpPhase& phase : scene.ocp.phases) phases.push_back({.name = phase.name});
  for (const PlanInterval& interval : plan.intervals()) {
    PhaseSummary& phase = phases[static_cast<std::size_t>(interval.phase)];
    if (phase.intervals++ == 0) phase.begin = interval.t;
    phase.end = interval.t + interval.length;
  }
  return phases;
}

/// Rows stay in FILE.partial where there is no plan.
void write_trajectory(const std::string& path, const Dae& dae, const PlannerOutcome& outcome) {
  CsvWriter csv(path, trajectory_columns(dae));
  Dae::Workspace workspace = dae.make_workspace();
  std::vector<double> row;
  for (const DaeState& state : outcome.plan.samples(kRowsOfAnInterval)) {
    trajectory_row(dae, state, workspace, row);
    for (const double value : row) csv << value;
    csv.end_row();
  }
  if (succeeded(outcome.result.status)) csv.finish();
}

Json json_of(const std::vector<Obstacle>& obstacles) {
  Json list = Json::array();
  for (const Obstacle& o : obstacles) {
    list.push(Json::object()
                  .set("name", o.limit.name)
                  .set("kind", o.limit.is_bound ? "bound" : "row")
                  .set("value", o.limit.value)
                  .set("violation", o.limit.violation)
                  .set("stage", o.stage)
                  .set("t", o.t));
  }
  return list;
}

Json json_of(const OcpScene& scene, const PlannerOutcome& outcome, const std::string& solver, const Obstacles& obstacles) {
  const Dae& dae = *scene.ocp.dae;
  const Result& result = outcome.result;
  Json phases = Json::array(), end_error = Json::object();
  for (const PhaseSummary& p : phases_of(scene, outcome.plan))
    phases.push(Json::object().set("name", p.name).set("intervals", p.intervals).set("begin", p.begin).set("end", p.end));
  for (int i = 0; i < dae.num_states(); ++i) end_error.set(dae.state_name(i), outcome.error.end[i]);
  Json json = Json::object()
                  .set("schema", 1)
                  .set("scene", scene.ocp.name)
                  .set("solver", solver)
                  .set("status", to_string(result.status))
                  .set("objective", result.objective)
                  .set("iterations", outcome.iterations)
                  .set("time_s", outcome.elapsed)
                  .set("residual", residual_json(result.residual))
                  .set("duration", outcome.plan.duration())
                  .set("phases", phases)
                  .set("mesh", Json::object()
                                   .set("points", scene.points)
                                   .set("refinements", outcome.refinements)
                                   .set("error", outcome.error.worst)
                                   .set("tolerance", scene.tolerance)
                                   .set("end_error", end_error));
  if (obstacles.violated.empty()) return json;
  return json.set("infeasible_constraints", json_of(obstacles.violated)).set("held_back_by", json_of(obstacles.holding));
}

std::string text_of(const OcpScene& scene, const PlannerOutcome& outcome, const std::string& solver) {
  const Result& result = outcome.result;
  std::string text = fmt::format("{}: {} by {}; {} iterations, {}\n", scene.ocp.name, to_string(result.status), solver, outcome.iterations,
                                 duration_text(outcome.elapsed));
  const auto line = [&](const char* what, const std::string& value) { text += fmt::format("  {:<14}{}\n", what, value); };
  line("objective", fmt::format("{:.10g}", result.objective));
  line("duration", fmt::format("{:.6g} s", outcome.plan.duration()));
  for (const PhaseSummary& p : phases_of(scene, outcome.plan))
    line("phase", fmt::format("{}: {:.6g} to {:.6g} s, {} intervals of {} points", p.name, p.begin, p.end, p.intervals, scene.points));
  line("mesh error",
       fmt::format("{:.2g} of a step at most, {:.2g} asked; {} refinements", outcome.error.worst, scene.tolerance, outcome.refinements));
  Eigen::Index worst = 0;
  const double end = outcome.error.end.maxCoeff(&worst);
  line("at the end", fmt::format("{:.2g} in {}, open loop", end, scene.ocp.dae->state_name(static_cast<int>(worst))));
  line("residual", fmt::format("stationarity {:.2e}, primal {:.2e}, complementarity {:.2e}", result.residual.stationarity,
                               result.residual.primal, result.residual.complementarity));
  if (!next_step(result.status).empty()) line("next", std::string(next_step(result.status)));
  return text;
}

}  // namespace

int run_plan(const Arguments& given) {
  Arguments arguments = given;
  check_report(arguments);
  if (arguments.output.empty()) arguments.output = record_beside_report(arguments, ".csv", "");
  if (arguments.trace.empty()) arguments.trace = record_beside_report(arguments, ".jsonl", "");
  if (is_task(arguments.names.front())) return plan_task(arguments);
  const OcpScene scene = load_ocp_scene(arguments.names.front(), arguments.set);
  if (!arguments.output.empty()) check_output_path(arguments.output);
  const std::string solver = arguments.solver.value_or(default_solver());
  PlannerOptions options{
      .points = scene.points, .tolerance = scene.tolerance, .refinements = scene.refinements, .solver = arguments.options()};
  Observers observers(arguments);
  options.solver.on_iteration = observers.callback();
  long solves = 0;
  const auto factory = [&](const Nlp& problem, const Options& of_solver) {
    observers.begin_row(solves++);
    return make_solver(solver, problem, of_solver);
  };
  const PlannerOutcome outcome = make_plan(scene.ocp, factory, options);
  observers.finish();

  const bool is_done = succeeded(outcome.result.status);
  const std::string output = arguments.output.empty() && !arguments.json ? "-" : arguments.output;
  if (!output.empty()) write_trajectory(output, *scene.ocp.dae, outcome);
  Obstacles obstacles;
  if (is_done) {
    write_scenery(scene.scenery, arguments.output);
    make_report(arguments, {arguments.output, arguments.trace});
  } else if (!interrupted()) {
    obstacles = obstacles_of(outcome);
    fmt::print(stderr, "tenon: {}: {}\n", scene.ocp.name, obstacles.text(outcome.result.status));
  }
  if (arguments.json)
    print(json_of(scene, outcome, solver, obstacles));
  else if (!arguments.quiet)
    fmt::print(arguments.output.empty() ? stderr : stdout, "{}", text_of(scene, outcome, solver));
  if (interrupted()) return kInterrupted;
  return is_done ? kFinished : kNotSolved;
}

}  // namespace tenon
