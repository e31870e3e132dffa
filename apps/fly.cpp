// tenon fly MISSION: a closed loop from a noisy pose to throttles and arm angles, and the rigid body under them. The record is CSV; without
// --output it goes to stdout.
#include <fmt/format.h>

#include <chrono>
#include <numbers>
#include <optional>
#include <thread>

#include "tenon/apps/flight.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/make_allocator.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/trajectory.hpp"
#include "tenon/problems/flight/flight_scenery.hpp"
#include "tenon/problems/flight/mission_file.hpp"

namespace tenon {

namespace {

using flight::FlightStatistics;
using flight::FlightTick;
using flight::Moments;

constexpr double kDegrees = 180 / std::numbers::pi;

class FlightRecord {
 public:
  FlightRecord(const Arguments& arguments, const flight::FlightDae& dae)
      : arguments_(arguments),
        dae_(dae),
        workspace_(dae.make_workspace()),
        progress_("fly", std::lround(1e4), arguments.quiet),
        start_(std::chrono::steady_clock::now()) {
    std::vector<std::string> columns = trajectory_columns(dae);
    columns.emplace_back("status");
    if (!arguments.output.empty() || !arguments.json) trajectory_.emplace(arguments.output.empty() ? "-" : arguments.output, columns);
    if (!arguments.events.empty()) events_.emplace(arguments.events, std::vector<std::string>{"t", "contact", "from", "to"});
  }

  /// False where the flight is to stop.
  bool add(const DaeState& state, const FlightTick& tick) {
    if (trajectory_ && ticks_++ % dae_.mission().output_ticks == 0) {
      trajectory_row(dae_, state, workspace_, row_);
      for (const double value : row_) *trajectory_ << value;
      *trajectory_ << to_string(tick.status);
      trajectory_->end_row();
    }
    progress_.update(std::lround(1e4 * state.t / dae_.mission().duration));
    if (arguments_.real_time) {
      std::this_thread::sleep_until(
          start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(state.t)));
    }
    return !interrupted();
  }

  void add(const DaeEvent& event) {
    if (!events_) return;
    *events_ << event.t << event.contact << word(event.contact, event.from) << word(event.contact, event.to);
    events_->end_row();
  }

  void finish() {
    if (trajectory_) trajectory_->finish();
    if (events_) events_->finish();
  }

  /// Where the rows are that an early end leaves; empty where that is no file.
  std::string partial() const { return trajectory_ && !arguments_.output.empty() ? trajectory_->file().partial_path() : ""; }
  long rows() const { return trajectory_ ? trajectory_->rows() : 0; }

 private:
  static const char* word(const std::string& what, int value) {
    if (what.starts_with(flight::kRotor) || what.starts_with(flight::kServo)) return value == 0 ? "working" : "failed";
    return value == 0 ? "free" : value > 0 ? "upper" : "lower";
  }

  const Arguments& arguments_;
  const flight::FlightDae& dae_;
  Dae::Workspace workspace_;
  Progress progress_;
  std::chrono::steady_clock::time_point start_;
  std::optional<CsvWriter> trajectory_, events_;
  std::vector<double> row_;
  long ticks_ = 0;
};

/// The only transition that fails is that of a flight that is lost.
std::string_view status_of(const FlightResult& result) {
  return result.status == IntegrationStatus::transition_failed ? "lost" : to_string(result.status);
}

Json json_of(const Moments& error, double unit) {
  return Json::object().set("mean", unit * error.mean()).set("sd", unit * error.sd()).set("max", unit * error.max());
}

Json json_of(const FlightResult& result, const flight::Mission& mission, const std::string& solver) {
  const FlightStatistics& s = result.statistics;
  return Json::object()
      .set("schema", 1)
      .set("mission", mission.name)
      .set("vehicle", mission.vehicle.name)
      .set("solver", solver)
      .set("status", status_of(result))
      .set("explanation", result.explanation)
      .set("t", result.state.t)
      .set("ticks", s.ticks)
      .set("position_error", json_of(s.position_error, 1))
      .set("angle_error", json_of(s.angle_error, kDegrees))
      .set("limits_hit", s.limits_hit)
      .set("limits_violated", s.limits_violated)
      .set("allocation_failures", s.allocation_failures)
      .set("best_effort", s.best_effort)
      .set("time_s", result.elapsed);
}

std::string text_of(const FlightResult& result, const flight::Mission& mission, const std::string& solver) {
  const FlightStatistics& s = result.statistics;
  const auto moments = [](const Moments& m, double unit, const char* name) {
    return fmt::format("mean {:.3g} {}, sd {:.3g}, at most {:.3g}", unit * m.mean(), name, unit * m.sd(), unit * m.max());
  };
  std::string text = fmt::format("{}: {} at t = {:.6g} s; {} ticks of {}, {}\n", mission.name, status_of(result), result.state.t, s.ticks, solver,
                                 duration_text(result.elapsed));
  const auto line = [&text](const char* what, const std::string& value) { text += fmt::format("  {:<16}{}\n", what, value); };
  line("position error", moments(s.position_error, 1e3, "mm"));
  line("angle error", moments(s.angle_error, kDegrees, "deg"));
  line("allocation", fmt::format("{} solved, {} best_effort, {} fallback; short by at most {:.2g} N, {:.2g} N m",
                                 s.ticks - s.best_effort - s.allocation_failures, s.best_effort, s.allocation_failures, s.largest_force_error,
                                 s.largest_torque_error));
  line("limits", fmt::format("{} times hit, {} times violated", s.limits_hit, s.limits_violated));
  return text;
}

}  // namespace

int run_fly(const Arguments& given) {
  Arguments arguments = given;
  check_report(arguments);
  if (arguments.output.empty()) arguments.output = record_beside_report(arguments, ".csv", "");
  if (arguments.events.empty()) arguments.events = record_beside_report(arguments, ".events.csv", "");
  flight::Mission mission = flight::load_mission(arguments.names.front(), arguments.set);
  mission.seed = arguments.seed;
  const std::string solver = arguments.solver.value_or(default_allocator());
  make_allocator(mission.vehicle, solver, {});  // a solver that nobody knows is bad input, not a flight that fails
  const flight::FlightDae dae(mission, allocator_maker(solver));
  FlightRecord record(arguments, dae);

  const FlightResult result = fly(dae, {.on_tick = [&](const DaeState& state, const FlightTick& tick) { return record.add(state, tick); },
                                        .on_event = [&](const DaeEvent& event) { record.add(event); }});
  const std::string rows = record.partial().empty() ? "" : fmt::format("{} rows are in {}", record.rows(), record.partial());
  if (result.status == IntegrationStatus::stopped) {
    if (!rows.empty()) fmt::print(stderr, "tenon: interrupted, {}\n", rows);
    return kInterrupted;
  }
  const bool is_done = result.status == IntegrationStatus::reached;
  if (is_done) {
    record.finish();
    write_scenery(flight::flight_scenery(mission), arguments.output);
    make_report(arguments, {arguments.output, arguments.events});
  } else {
    fmt::print(stderr, "tenon: {}: {}{}{}\n", mission.name, result.explanation, rows.empty() ? "" : "; ", rows);
  }
  if (arguments.json)
    print(json_of(result, mission, solver));
  else if (!arguments.quiet)
    fmt::print(arguments.output.empty() ? stderr : stdout, "{}", text_of(result, mission, solver));
  return is_done ? kFinished : kNotSolved;
}

}  // namespace tenon
