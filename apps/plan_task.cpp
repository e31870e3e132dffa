#include "tenon/apps/plan_task.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/exit_code.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/next_step.hpp"
#include "tenon/apps/observers.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/core/explanation.hpp"
#include "tenon/core/scenery.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

/// Rows stay in FILE.partial where there is no plan.
void write_trajectory(const std::string& path, const HorizonProgram& program, const Point& plan, bool is_done) {
  std::vector<std::string> columns = program.trajectory_columns();
  Vector values(static_cast<Eigen::Index>(columns.size()));
  columns.insert(columns.begin(), "t");
  CsvWriter csv(path, columns);
  const int stages = static_cast<int>(program.stages().stages.size());
  for (int k = 0; k < stages; ++k) {
    csv << k * program.interval();
    program.trajectory(plan, k, values);
    for (const double value : values) csv << value;
    csv.end_row();
  }
  if (is_done) csv.finish();
}

/// The task's picture without what a plan does not have: other plans and estimates.
Scenery scenery_of_plan(Scenery scenery, const std::vector<std::string>& columns) {
  scenery.ghosts.clear(), scenery.ellipses.clear(), scenery.estimates.clear();
  std::erase_if(scenery.bodies, [](const SceneryBody& body) { return body.outline; });
  for (SceneryPlot& plot : scenery.plots) {
    plot.foresights.clear(), plot.bands.clear();
    std::erase_if(plot.columns, [&](const std::string& column) { return std::ranges::find(columns, column) == columns.end(); });
  }
  std::erase_if(scenery.plots, [](const SceneryPlot& plot) { return plot.columns.empty(); });
  return scenery;
}

}  // namespace

int plan_task(const Arguments& arguments) {
  const ControlTask task = make_task(arguments.names.front(), arguments.set);
  if (!task.whole_program) throw std::invalid_argument(task.name + ": has nothing to plan, its commands are a script");
  const std::unique_ptr<HorizonProgram> whole = task.whole_program();
  const HorizonProgram& program = *whole;
  const std::string solver = arguments.solver.value_or(default_solver());
  Observers observers(arguments);
  Options options = arguments.options({.scaling = task.options.cold.scaling});
  options.on_iteration = observers.callback();
  Point point(program.num_variables(), program.num_constraints());
  program.initial_point(point.x);
  const Result result = make_solver(solver, program, options)->solve(point);
  observers.finish();

  const bool is_done = succeeded(result.status);
  const std::string output = arguments.output.empty() && !arguments.json ? "-" : arguments.output;
  if (!output.empty()) write_trajectory(output, program, point, is_done);
  if (is_done) {
    write_scenery(scenery_of_plan(task.scenery, program.trajectory_columns()), arguments.output);
    make_report(arguments, {arguments.output, arguments.trace});
  } else if (!interrupted()) {
    fmt::print(stderr, "tenon: {}: {}\n{}\n", task.name, to_string(result.status), explain(program, point, result).text());
  }
  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("scene", task.name)
              .set("solver", solver)
              .set("status", to_string(result.status))
              .set("objective", result.objective)
              .set("iterations", result.iterations)
              .set("time_s", result.elapsed)
              .set("residual", residual_json(result.residual)));
  } else if (!arguments.quiet) {
    fmt::print(arguments.output.empty() ? stderr : stdout, "{}: {} by {}; {} iterations, {}\n  objective {:.10g}, over {:.4g} s in {} intervals{}\n",
               task.name, to_string(result.status), solver, result.iterations, duration_text(result.elapsed), result.objective,
               program.interval() * static_cast<double>(program.stages().stages.size() - 1), program.stages().stages.size() - 1,
               is_done ? "" : "\n  " + std::string(next_step(result.status)));
  }
  if (interrupted()) return kInterrupted;
  return is_done ? kFinished : kNotSolved;
}

}  // namespace tenon
