#include "tenon/apps/plan_task.hpp"

#include <fmt/format.h>

#include <cmath>

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
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

/// "lambda[3]" of stage 3 is the column "lambda".
std::string column_of(const std::string& variable) {
  return variable.substr(0, variable.find('['));
}

/// Rows stay in FILE.partial where there is no plan. The last stage has states alone: its other cells are empty.
void write_stages(const std::string& path, const HorizonProgram& program, const Vector& x, bool is_done) {
  const Stages stages = program.stages();
  const IndexRange first = stages.stages.front().variables;
  std::vector<std::string> columns{"t"};
  for (int i = first.begin; i < first.end; ++i) columns.push_back(column_of(program.variable_name(i)));
  CsvWriter csv(path, columns);
  for (std::size_t k = 0; k < stages.stages.size(); ++k) {
    const IndexRange variables = stages.stages[k].variables;
    csv << static_cast<double>(k) * program.interval();
    for (int i = 0; i < first.size(); ++i) {
      if (i < variables.size())
        csv << x[variables.begin + i];
      else
        csv << "";
    }
    csv.end_row();
  }
  if (is_done) csv.finish();
}

}  // namespace

int plan_task(const Arguments& arguments) {
  const ControlTask task = make_task(arguments.names.front(), arguments.set);
  if (!task.program) throw std::invalid_argument(task.name + ": has nothing to plan, its commands are a script");
  const HorizonProgram& program = *task.program;
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
  if (!output.empty()) write_stages(output, program, point.x, is_done);
  if (is_done)
    make_report(arguments, {arguments.output, arguments.trace});
  else if (!interrupted())
    fmt::print(stderr, "tenon: {}: {}\n{}\n", task.name, to_string(result.status), explain(program, point, result).text());
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
