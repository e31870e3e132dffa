// tenon simulate SCENE: a hybrid DAE in time. The trajectory and the events are CSV; without --output the trajectory goes to stdout.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <thread>

#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/simulation.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/output_file.hpp"
#include "tenon/core/trajectory.hpp"
#include "tenon/problems/contact/collision.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFastPhasePoints = 100;  // of one collision in its own time

/// Of one contact, over the whole run.
struct ContactSummary {
  int collisions = 0;
  double impulse = 0;
};

class SimulationRecord {
 public:
  SimulationRecord(const Arguments& arguments, const Simulation& simulation)
      : arguments_(arguments),
        collisions_(simulation.collisions),
        dae_(*simulation.dae),
        workspace_(dae_.make_workspace()),
        progress_("simulate", std::lround(1e4), arguments.quiet),
        duration_(simulation.settings.duration) {
    const std::vector<std::string> columns = trajectory_columns(dae_);
    if (!arguments.output.empty() || !arguments.json) trajectory_.emplace(arguments.output.empty() ? "-" : arguments.output, columns);
    if (!arguments.events.empty()) events_.emplace(arguments.events, event_columns());
    if (!arguments.fast_phase.empty())
      fast_phase_.emplace(arguments.fast_phase, std::vector<std::string>{"t", "contact", "tau", "gap", "gap_rate", "gap_acceleration"});
    energy_ = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "energy") - columns.begin());
    saturated_ = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "saturated") - columns.begin());
    audit_ = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "energy_error") - columns.begin());
    start_ = Clock::now();
  }

  /// False where the run is to stop.
  bool add(const DaeState& state) {
    trajectory_row(dae_, state, workspace_, row_);
    if (trajectory_) {
      for (const double value : row_) *trajectory_ << value;
      trajectory_->end_row();
    }
    if (energy_ < row_.size()) last_energy_ = row_[energy_];
    if (saturated_ < row_.size() && row_[saturated_] != 0) ++saturated_rows_;
    if (audit_ < row_.size()) largest_error_ = std::max(largest_error_, std::abs(row_[audit_]));
    ++rows_;
    progress_.update(std::lround(1e4 * state.t / duration_));
    if (arguments_.real_time)
      std::this_thread::sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(state.t)));
    return !interrupted();
  }

  void add(const DaeEvent& event) {
    if (events_) write_event(*events_, event);
    if (fast_phase_ && event.from == 0 && event.to == 1) write_fast_phase(event);
    ++event_count_;
    if (event.from == 0 && event.to == 1) {
      ++contacts_[event.contact].collisions;
      contacts_[event.contact].impulse += event.impulse;
    }
  }

  void finish() {
    if (trajectory_) trajectory_->finish();
    if (events_) events_->finish();
    if (fast_phase_) fast_phase_->finish();
  }

  std::string partial() const { return trajectory_ && !arguments_.output.empty() ? trajectory_->file().partial_path() : ""; }
  long rows() const { return rows_; }

  Json json(const IntegrationResult& result, const DaeState& state, const std::string& integrator) const {
    Json contacts = Json::array();
    for (const auto& [name, c] : contacts_)
      contacts.push(Json::object().set("name", name).set("collisions", c.collisions).set("impulse", c.impulse));
    Json final_state = Json::object();
    for (int i = 0; i < dae_.num_states(); ++i) final_state.set(dae_.state_name(i), state.x[i]);
    for (int i = 0; i < dae_.num_algebraics(); ++i) final_state.set(dae_.algebraic_name(i), state.y[i]);
    return Json::object()
        .set("schema", 1)
        .set("scene", dae_.name())
        .set("integrator", integrator)
        .set("status", to_string(result.status))
        .set("explanation", result.explanation)
        .set("t", state.t)
        .set("steps", result.steps)
        .set("evaluations", result.evaluations)
        .set("time_s", elapsed())
        .set("events", event_count_)
        .set("contacts", contacts)
        .set("saturated_rows", saturated_rows_)
        .set("energy", last_energy_)
        .set("energy_error", largest_error_)
        .set("final", final_state);
  }

  std::string text(const IntegrationResult& result, const DaeState& state, const std::string& integrator) const {
    std::string text = fmt::format("{}: {} at t = {:.6g} s; {} steps of {}, {:.3g} ms\n", dae_.name(), to_string(result.status), state.t,
                                   result.steps, integrator, 1e3 * elapsed());
    text += fmt::format("energy {:.12g} J, largest error of its audit {:.2g} J\n", last_energy_, largest_error_);
    if (saturated_rows_ > 0) text += fmt::format("motors at their limits in {} of {} rows\n", saturated_rows_, rows_);
    if (contacts_.empty()) return text;
    Table table({"contact", "collisions", "impulse"});
    for (const auto& [name, c] : contacts_) table.add({name, fmt::format("{}", c.collisions), fmt::format("{:.6g}", c.impulse)});
    return text + table.text();
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// A collision in its own time scale, by the law that gives this contact its restitution.
  void write_fast_phase(const DaeEvent& event) {
    const auto law = collisions_.find(event.contact);
    if (law == collisions_.end() || !(event.gap_rate_before < 0)) return;
    for (const contact::FastPoint& point : contact::collision_path(law->second, -event.gap_rate_before, kFastPhasePoints)) {
      *fast_phase_ << event.t << event.contact << point.tau << point.gap << point.rate << point.acceleration;
      fast_phase_->end_row();
    }
  }

  const Arguments& arguments_;
  const std::map<std::string, contact::Law>& collisions_;
  const Dae& dae_;
  Dae::Workspace workspace_;
  Progress progress_;
  double duration_;
  std::optional<CsvWriter> trajectory_, events_, fast_phase_;
  std::vector<double> row_;
  std::size_t energy_ = 0, audit_ = 0, saturated_ = 0;  // their columns
  double last_energy_ = 0, largest_error_ = 0;
  std::map<std::string, ContactSummary> contacts_;
  long rows_ = 0, saturated_rows_ = 0, event_count_ = 0;
  Clock::time_point start_;
};

}  // namespace

int run_simulate(const Arguments& given) {
  Arguments arguments = given;
  check_report(arguments);
  if (arguments.output.empty()) arguments.output = record_beside_report(arguments, ".csv", "");
  if (arguments.events.empty()) arguments.events = record_beside_report(arguments, ".events.csv", "");
  if (arguments.fast_phase.empty()) arguments.fast_phase = record_beside_report(arguments, ".fast.csv", "");
  const Simulation simulation = open_simulation(arguments.names.front(), arguments.set);
  const std::string name = arguments.solver.value_or(simulation.settings.integrator);
  IntegratorOptions options;
  options.rtol = arguments.tolerance.value_or(simulation.settings.rtol);
  options.atol = arguments.tolerance ? 1e-2 * options.rtol : simulation.settings.atol;
  options.output_step = simulation.settings.output_step;
  std::optional<SimulationRecord> record;
  options.on_output = [&](const DaeState& state) { return record->add(state); };
  options.on_event = [&](const DaeEvent& event) { record->add(event); };
  const auto integrator = make_integrator(name, *simulation.dae, options);
  DaeState state = initial_state_of(*simulation.dae);
  record.emplace(arguments, simulation);

  const IntegrationResult result = integrator->advance(state, simulation.settings.duration);
  const bool is_done = result.status == IntegrationStatus::reached;
  if (result.status == IntegrationStatus::stopped) {
    if (!record->partial().empty()) fmt::print(stderr, "tenon: interrupted, {} rows are in {}\n", record->rows(), record->partial());
    return kInterrupted;
  }
  if (is_done) {
    record->finish();
    write_scenery(simulation.scenery, arguments.output);
    make_report(arguments, {arguments.output, arguments.events, arguments.fast_phase});
  } else {
    fmt::print(stderr, "tenon: {}: {}\n", simulation.dae->name(), result.explanation);
  }
  if (arguments.json)
    print(record->json(result, state, name));
  else if (!arguments.quiet)
    fmt::print(arguments.output.empty() ? stderr : stdout, "{}", record->text(result, state, name));
  return is_done ? kFinished : kNotSolved;
}

}  // namespace tenon
