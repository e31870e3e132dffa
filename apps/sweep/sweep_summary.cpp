#include "tenon/apps/sweep/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tenon/apps/statistics.hpp"
#include "tenon/apps/table.hpp"

namespace tenon {

namespace {

constexpr const char* kController = "mpc";

/// "straight-down.time" is the column "time" of "straight-down"; what has no such name is the controller's.
std::string contestant_of(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? kController : name.substr(0, dot);
}
std::string column_of(const std::string& name) {
  return name.substr(name.find('.') + 1);
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::vector<double> finite_values(const std::map<std::uint64_t, Vector>& rows, int column) {
  std::vector<double> values;
  for (const auto& [seed, row] : rows) {
    if (std::isfinite(row[column])) values.push_back(row[column]);
  }
  return values;
}

}  // namespace

SweepSummary::SweepSummary(std::string scene, const std::vector<std::string>& names, const std::string& severity,
                           const std::map<std::uint64_t, Vector>& rows)
    : scene_(std::move(scene)), samples_(static_cast<int>(rows.size())) {
  const int success = index_of(names, "success");
  for (int c = success; c < static_cast<int>(names.size()); ++c) {
    const std::string& name = names[static_cast<std::size_t>(c)];
    const std::vector<double> values = finite_values(rows, c);
    if (column_of(name) == "success") {
      const int successes = static_cast<int>(std::count(values.begin(), values.end(), 1.0));
      contestants_.push_back({contestant_of(name), successes, success_interval(successes, samples_), {}});
    } else {
      contestants_.back().spreads.push_back({column_of(name), median(values), percentile(values, 0.95), percentile(values, 1)});
    }
  }

  const int how_bad = index_of(names, severity);
  const auto badness = [&](const Vector& row) {
    if (row[success] != 1) return std::numeric_limits<double>::infinity();
    return how_bad < row.size() ? row[how_bad] : 0.0;
  };
  const auto worst = std::max_element(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return badness(a.second) < badness(b.second); });
  if (worst == rows.end()) return;
  worst_seed_ = worst->first;
  for (std::size_t c = 0; c < names.size() && contestant_of(names[c]) == kController; ++c) {
    worst_.emplace_back(names[c], worst->second[static_cast<int>(c)]);
  }
}

void SweepSummary::set_figures(Json& json, const Contestant& contestant) const {
  Json percentiles = Json::object();
  for (const Spread& s : contestant.spreads) {
    percentiles.set(s.column, Json::object().set("median", s.median).set("p95", s.p95).set("max", s.max));
  }
  json.set("samples", samples_)
      .set("successes", contestant.successes)
      .set("success_rate", samples_ > 0 ? static_cast<double>(contestant.successes) / samples_ : 0)
      .set("interval", Json::array().push(contestant.interval.lower).push(contestant.interval.upper))
      .set("percentiles", percentiles);
}

Json SweepSummary::json() const {
  Json result = Json::object().set("schema", 1).set("scene", scene_);
  set_figures(result, contestants_.front());
  Json worst = Json::object().set("seed", static_cast<double>(worst_seed_));
  for (const auto& [name, value] : worst_) worst.set(name, value);
  result.set("worst", worst);
  Json baselines = Json::array();
  for (std::size_t i = 1; i < contestants_.size(); ++i) {
    Json baseline = Json::object().set("name", contestants_[i].name);
    set_figures(baseline, contestants_[i]);
    baselines.push(baseline);
  }
  if (contestants_.size() > 1) result.set("baselines", baselines);
  return result;
}

std::string SweepSummary::text() const {
  std::vector<std::string> header{"controller", "success", "95 % interval"};
  for (const Spread& s : contestants_.front().spreads) header.push_back(s.column + " median/p95/max");
  Table table(header);
  for (const Contestant& c : contestants_) {
    std::vector<std::string> row{c.name, fmt::format("{}/{}", c.successes, samples_),
                                 fmt::format("{:.2f} to {:.2f} %", 100 * c.interval.lower, 100 * c.interval.upper)};
    for (const Spread& s : c.spreads) row.push_back(fmt::format("{:.4g}/{:.4g}/{:.4g}", s.median, s.p95, s.max));
    row.resize(header.size());
    table.add(row);
  }
  return fmt::format("{}: {} samples\n{}worst: --seed {}\n", scene_, samples_, table.text(), worst_seed_);
}

}  // namespace tenon
