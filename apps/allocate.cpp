// tenon allocate VEHICLE --wrenches FILE.csv: a wrench log becomes throttles and arm angles, row by row, each from the one before.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <stdexcept>

#include "tenon/apps/allocation_summary.hpp"
#include "tenon/apps/comma_list.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_allocator.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/observers.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/allocation/vehicle_scenery.hpp"
#include "tenon/problems/allocation/wrench_log.hpp"

namespace tenon {

namespace {

std::vector<std::string> column_names(int rotors) {
  std::vector<std::string> names{"t"};
  for (int i = 1; i <= rotors; ++i) names.push_back(fmt::format("u{}", i));
  for (int i = 1; i <= rotors; ++i) names.push_back(fmt::format("a{}", i));
  for (const char* name : {"status", "iterations", "fallback", "objective", "residual", "Fx_error", "Fy_error", "Fz_error", "Mx_error",
                           "My_error", "Mz_error", "time_us"}) {
    names.emplace_back(name);
  }
  return names;
}

void write_row(CsvWriter& csv, double t, const Allocation& allocation) {
  csv << t;
  for (const double u : allocation.throttle) csv << u;
  for (const double a : allocation.angle) csv << a;
  csv << to_string(allocation.status) << allocation.iterations << (allocation.status == AllocationStatus::fallback ? 1 : 0)
      << allocation.objective << allocation.residual;
  for (const double e : allocation.error) csv << e;
  csv << allocation.elapsed * 1e6;
  csv.end_row();
}

/// Hands the vehicle's failures to the allocator and its judge when their time has come.
class Failures {
 public:
  explicit Failures(const Vehicle& vehicle)
      : vehicle_(vehicle), rotor_(vehicle.rotors.size(), false), servo_(vehicle.rotors.size(), false) {}

  void apply(double t, Allocator& allocator, AllocationSummary& summary, bool quiet) {
    for (std::size_t i = 0; i < rotor_.size(); ++i) {
      if (!rotor_[i] && t >= vehicle_.rotors[i].fails_at) {
        rotor_[i] = true;
        allocator.fail_rotor(static_cast<int>(i));
        summary.fail_rotor(static_cast<int>(i));
        if (!quiet) fmt::print(stderr, "t = {} s: rotor {} fails\n", t, i + 1);
      }
      if (!servo_[i] && t >= vehicle_.rotors[i].servo_sticks_at) {
        servo_[i] = true;
        allocator.stick_servo(static_cast<int>(i));
        summary.stick_servo(static_cast<int>(i));
        if (!quiet) fmt::print(stderr, "t = {} s: the servo of rotor {} sticks\n", t, i + 1);
      }
    }
  }

 private:
  const Vehicle& vehicle_;
  std::vector<bool> rotor_, servo_;
};

Scenery scenery_of(const Vehicle& vehicle) {
  Scenery scenery = vehicle_scenery(vehicle);
  scenery.title = vehicle.name + ": wrench allocation";
  return scenery;
}

Options allocation_options(const Arguments& arguments, const SolverChoice& choice, Observers& observers) {
  Options options = arguments.options();
  if (!arguments.tolerance && choice.tolerance) options.tolerance = *choice.tolerance;
  if (!arguments.max_iterations && choice.max_iterations) options.max_iterations = *choice.max_iterations;
  validate(options);
  if (observers.wanted()) options.on_iteration = observers.callback();
  return options;
}

}  // namespace

int run_allocate(const Arguments& arguments) {
  if (arguments.wrenches.empty()) throw std::invalid_argument("allocate: nothing to allocate (expected --wrenches FILE.csv)");
  if (arguments.cold && arguments.initial) throw std::invalid_argument("--cold and --initial exclude one another (expected one of them)");
  const VehicleFile file = load_vehicle(arguments.names.front(), arguments.set);
  const Vehicle& vehicle = file.vehicle;
  const std::string solver = arguments.solver.value_or(file.solver.name.value_or(default_allocator()));
  Observers observers(arguments);
  const std::unique_ptr<Allocator> allocator = make_allocator(vehicle, solver, allocation_options(arguments, file.solver, observers));
  if (arguments.initial) {
    const std::vector<double> angles = parse_numbers("--initial", *arguments.initial, vehicle.rotors.size());
    allocator->reset(Eigen::Map<const Vector>(angles.data(), vehicle.num_rotors()));
  }
  const std::vector<WrenchRow> log = read_wrench_log(arguments.wrenches);
  if (!arguments.quiet) {
    for (const std::string& note : file.notes) fmt::print(stderr, "tenon: {}\n", note);
  }

  // Without --output the record goes beside the report, else to stdout, unless the summary does as JSON.
  const std::string record = !arguments.output.empty() ? arguments.output : record_beside_report(arguments, ".csv", arguments.json ? "" : "-");
  check_report(arguments);
  std::optional<CsvWriter> csv;
  if (!record.empty()) csv.emplace(record, column_names(vehicle.num_rotors()));
  AllocationSummary summary(vehicle, solver);
  Failures failures(vehicle);
  {
    Progress progress("allocate", std::ssize(log), arguments.quiet);
    for (std::size_t k = 0; k < log.size() && !interrupted(); ++k) {
      if (arguments.cold) allocator->reset();
      observers.begin_row(static_cast<long>(k));
      failures.apply(log[k].t, *allocator, summary, arguments.quiet);
      const Allocation& allocation = allocator->allocate(log[k].wrench, log[k].dt);
      if (csv) write_row(*csv, log[k].t, allocation);
      summary.add(log[k].wrench, log[k].dt, k > 0 && !arguments.cold, allocation);
      progress.update(static_cast<long>(k) + 1);
    }
  }
  if (interrupted()) {
    if (csv && record != "-")
      fmt::print(stderr, "tenon: interrupted, {} rows are in {}\n", csv->rows(), csv->file().partial_path());
    return kInterrupted;
  }
  if (csv) csv->finish();
  observers.finish();
  write_scenery(scenery_of(vehicle), record);
  make_report(arguments, {record});
  if (arguments.json)
    print(summary.json());
  else if (!arguments.quiet)
    fmt::print(record == "-" ? stderr : stdout, "{}", summary.text());
  return kFinished;
}

}  // namespace tenon
