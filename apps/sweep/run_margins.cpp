#include "tenon/apps/sweep/run_margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "tenon/apps/exit_code.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/sweep/open_experiment.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/mpc/mode_margins.hpp"
#include "tenon/mpc/monte_carlo.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

constexpr int kBisections = 7;
constexpr int kSamples = 8;  // where --samples does not say

/// Whether all worlds with this offset, to either side, are a success.
bool is_certain(Arguments arguments, const std::string& parameter, double offset, const SolverFactory& make_solver) {
  std::vector<std::uint64_t> seeds(static_cast<std::size_t>(std::max(arguments.samples, 1)));
  std::iota(seeds.begin(), seeds.end(), arguments.seed);
  arguments.baselines = false;
  bool certain = true;
  for (const double signed_offset : {offset, -offset}) {
    Arguments shifted = arguments;
    shifted.set.push_back(fmt::format("{}={}", parameter, signed_offset));
    const ExperimentFactory make_experiment = open_experiment(shifted, make_solver);
    const std::vector<std::string> names = make_experiment()->names();
    const auto success = std::find(names.begin(), names.end(), "success") - names.begin();
    run_samples(make_experiment, seeds, arguments.threads,
                {.on_row = [&](std::uint64_t, const Vector& row) { certain = certain && row[success] == 1; },
                 .go_on = [&] { return certain && !interrupted(); }});
    if (!certain) break;
  }
  return certain;
}

double certain_offset(const Arguments& arguments, const ControlTask::Capture& capture, const SolverFactory& make_solver) {
  if (is_certain(arguments, capture.parameter, capture.largest, make_solver)) return capture.largest;
  double certain = 0, uncertain = capture.largest;
  for (int i = 0; i < kBisections && !interrupted(); ++i) {
    const double middle = (certain + uncertain) / 2;
    (is_certain(arguments, capture.parameter, middle, make_solver) ? certain : uncertain) = middle;
  }
  return certain;
}

std::string text_of(double value, double scale, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.4g} {}", scale * value, unit) : "without end";
}

}  // namespace

int run_margins(const Arguments& given, const SolverFactory& make_solver) {
  Arguments arguments = given;
  if (arguments.samples < 1) arguments.samples = kSamples;
  const std::string& scene = arguments.names.front();
  const ControlTask task = make_task(scene, arguments.set);
  if (task.modes.empty()) throw std::invalid_argument(scene + ": has no modes whose margins could be told");

  Table table({"mode", "stable", "modulus margin", "at", "further delay", "stiffer contact", "passive below"});
  Json modes = Json::array();
  for (const LinearMode& mode : task.modes) {
    const ModeMargins m = mode_margins(mode);
    table.add({mode.name, m.stable ? "yes" : "no", fmt::format("{:.3f}", m.modulus), text_of(m.modulus_frequency, 1, "Hz"), text_of(m.delay, 1e3, "ms"),
               text_of(m.contact_stiffness, 1, "x"), text_of(m.passive_below, 1, "Hz")});
    modes.push(Json::object()
                   .set("mode", mode.name)
                   .set("stable", m.stable)
                   .set("modulus_margin", m.modulus)
                   .set("modulus_frequency", m.modulus_frequency)
                   .set("delay_margin", m.delay)
                   .set("contact_stiffness_factor", m.contact_stiffness)
                   .set("passive_below", m.passive_below));
  }
  Json result = Json::object().set("schema", 1).set("scene", scene).set("modes", modes);
  std::string text = table.text();
  if (task.capture) {
    const double offset = certain_offset(arguments, *task.capture, make_solver);
    if (interrupted()) return kInterrupted;
    result.set("capture", Json::object().set("parameter", task.capture->parameter).set("certain_to", offset).set("worlds", arguments.samples));
    text += fmt::format("{} up to {:.4g} to either side: all of {} worlds succeed{}\n", task.capture->parameter, offset, arguments.samples,
                        offset == task.capture->largest ? ", as far as was looked" : "");
  }
  if (arguments.json)
    print(result);
  else if (!arguments.quiet)
    fmt::print("{}", text);
  return kFinished;
}

}  // namespace tenon
