// tenon estimate SCENE --measurements FILE.csv: what a scene's estimator makes of a record, row by row, with how sure it is.
//
// The record has t and the scene's measurements and commands by name, as `tenon mpc SCENE --output FILE.csv` writes it; what else stands in
// it, the truth included, is not read.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

constexpr double kObserved = 0.7;  // of the prior's standard deviation: where more than this is left, little was learnt
constexpr double kTied = 0.99;     // of a correlation: beyond it two estimates are known together, not apart

std::vector<std::string> names_of(int count, const auto& name) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(name(i));
  return names;
}

void check_clock(const CsvTable& record) {
  const std::vector<double>& t = record["t"];
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (!(t[k] > t[k - 1])) throw InputError({record.file, record.lines[k], 1}, "the time does not go on", "a time that rises from row to row");
  }
}

/// Some columns of one row.
class Cells {
 public:
  Cells(const CsvTable& record, const std::vector<std::string>& names) : values_(static_cast<int>(names.size())) {
    for (const std::string& name : names) columns_.push_back(&record[name]);
  }
  const Vector& at(std::size_t row) {
    for (std::size_t c = 0; c < columns_.size(); ++c) values_[static_cast<int>(c)] = (*columns_[c])[row];
    return values_;
  }

 private:
  std::vector<const std::vector<double>*> columns_;
  Vector values_;
};

Eigen::MatrixXd covariance_of(const Estimator& estimator) {
  Eigen::MatrixXd covariance(estimator.num_estimates(), estimator.num_estimates());
  estimator.covariance(covariance);
  return covariance;
}

/// Of a scene's picture what an estimator alone can tell: no bodies, no truth.
Scenery belief_scenery(const ControlTask& task, const Estimator& estimator) {
  Scenery scenery;
  scenery.title = task.name + ": what is estimated";
  scenery.estimates = task.scenery.estimates;
  for (SceneryEstimate& estimate : scenery.estimates) estimate.across.truth = estimate.upward.truth = "";
  for (int i = 0; i < estimator.num_estimates(); ++i) {
    const std::string name = estimator.estimate_name(i);
    scenery.plots.push_back({.title = name + " and 2 standard deviations", .columns = {name}, .bands = {{name, "cov_" + name + "_" + name}}});
    for (const SceneryPlot& plot : task.scenery.plots) {
      if (std::ranges::count(plot.columns, name) > 0) scenery.plots.back().unit = plot.unit;
    }
  }
  return scenery;
}

/// Means and covariance of all estimates.
struct Beliefs {
  Vector mean;
  Eigen::MatrixXd covariance;

  explicit Beliefs(const Estimator& estimator) : mean(estimator.num_estimates()), covariance(covariance_of(estimator)) {
    estimator.mean(mean);
  }
  double deviation(int i) const { return std::sqrt(covariance(i, i)); }
  double correlation(int i, int j) const { return covariance(std::max(i, j), std::min(i, j)) / (deviation(i) * deviation(j)); }
};

struct Belief {
  std::string name;
  double mean, deviation, prior_deviation;
  bool is_observed;            // of what is known in proportion: by deviations relative to their means
  std::string companion = {};  // what its error is tied to most
  double correlation = 0;      // with that

  bool is_tied() const { return std::abs(correlation) >= kTied; }
  std::string remark() const {
    const std::string tie = is_tied() ? fmt::format("better known together with {} (correlation {:.3f})", companion, correlation) : "";
    if (is_observed) return tie;
    return "not observed: this record says little about it" + (tie.empty() ? "" : "; " + tie);
  }
};

std::vector<Belief> list_of(const Estimator& estimator, const Beliefs& prior) {
  const Beliefs now(estimator);
  std::vector<Belief> list;
  for (int i = 0; i < now.mean.size(); ++i) {
    const double before = prior.deviation(i), size = estimator.is_known_in_proportion(i) ? now.mean[i] / prior.mean[i] : 1;
    Belief belief{estimator.estimate_name(i), now.mean[i], now.deviation(i), before, now.deviation(i) <= kObserved * size * before};
    for (int j = 0; j < now.mean.size(); ++j) {
      if (j == i || !(std::abs(now.correlation(i, j)) > std::abs(belief.correlation))) continue;
      belief.companion = estimator.estimate_name(j);
      belief.correlation = now.correlation(i, j);
    }
    list.push_back(belief);
  }
  return list;
}

Json json_of(const std::vector<Belief>& beliefs, const std::string& scene, int rows) {
  Json estimates = Json::array(), unobserved = Json::array();
  for (const Belief& b : beliefs) {
    Json estimate = Json::object().set("name", b.name).set("mean", b.mean).set("sd", b.deviation).set("prior_sd", b.prior_deviation);
    if (b.is_tied()) estimate.set("tied_to", b.companion).set("correlation", b.correlation);
    estimates.push(estimate);
    if (!b.is_observed) unobserved.push(b.name);
  }
  return Json::object().set("schema", 1).set("scene", scene).set("rows", rows).set("estimates", estimates).set("not_observed", unobserved);
}

std::string text_of(const std::vector<Belief>& beliefs, const std::string& scene, int rows) {
  Table table({"estimate", "mean", "sd", "sd before", ""});
  for (const Belief& b : beliefs) {
    table.add({b.name, fmt::format("{:.6g}", b.mean), fmt::format("{:.3g}", b.deviation), fmt::format("{:.3g}", b.prior_deviation),
               b.remark()});
  }
  return fmt::format("{}: {} rows\n{}", scene, rows, table.text());
}

}  // namespace

int run_estimate(const Arguments& arguments) {
  const std::string& scene = arguments.names.front();
  if (arguments.measurements.empty()) throw std::invalid_argument("estimate: no record (expected --measurements FILE.csv)");
  ControlTask task = make_task(scene, arguments.set);
  const std::string solver = arguments.solver.value_or(default_solver());
  const std::unique_ptr<Estimator> taken =
      take_estimator(task, [&](const Nlp& problem, const Options& options) { return make_solver(solver, problem, options); });
  if (!taken) throw std::invalid_argument(scene + ": has nothing to estimate, its measurements say it all");
  Estimator& estimator = *taken;
  const std::vector<std::string> measured = names_of(task.plant->num_measurements(), [&](int i) { return task.plant->measurement_name(i); });
  const std::vector<std::string> commanded = names_of(task.plant->num_commands(), [&](int i) { return task.plant->command_name(i); });
  const std::vector<std::string> estimated = names_of(estimator.num_estimates(), [&](int i) { return estimator.estimate_name(i); });

  std::vector<std::string> wanted{"t"};
  wanted.insert(wanted.end(), measured.begin(), measured.end());
  wanted.insert(wanted.end(), commanded.begin(), commanded.end());
  const CsvTable record = read_csv(arguments.measurements, {.required = wanted, .optional = {}});
  check_clock(record);
  check_report(arguments);

  const std::string output = !arguments.output.empty() ? arguments.output : record_beside_report(arguments, ".csv", arguments.json ? "" : "-");
  std::optional<CsvWriter> csv;
  if (!output.empty()) {
    std::vector<std::string> columns{"t"};
    for (const std::string& name : estimated) columns.push_back(name);
    for (const std::string& name : estimated) columns.push_back("sd_" + name);
    for (const std::string& name : covariance_names(estimator)) columns.push_back(name);
    csv.emplace(output, columns);
  }

  Cells measurements(record, measured), commands(record, commanded);
  Vector held = Vector::Zero(static_cast<int>(commanded.size()));
  estimator.reset();
  const Beliefs prior(estimator);
  for (std::size_t k = 0; k < record.lines.size(); ++k) {
    estimator.update(record["t"][k], measurements.at(k), held);  // a row's command holds from there on
    held = commands.at(k);
    if (!csv) continue;
    const Beliefs now(estimator);
    *csv << record["t"][k];
    for (const double value : now.mean) *csv << value;
    for (int i = 0; i < now.mean.size(); ++i) *csv << now.deviation(i);
    for (Eigen::Index column = 0; column < now.covariance.cols(); ++column) {
      for (Eigen::Index row = column; row < now.covariance.rows(); ++row) *csv << now.covariance(row, column);
    }
    csv->end_row();
  }
  if (csv) csv->finish();
  if (csv) write_scenery(belief_scenery(task, estimator), output);
  make_report(arguments, {output});

  const std::vector<Belief> beliefs = list_of(estimator, prior);
  if (arguments.json)
    print(json_of(beliefs, scene, record.rows()));
  else if (!arguments.quiet)
    fmt::print(output == "-" ? stderr : stdout, "{}", text_of(beliefs, scene, record.rows()));
  return kFinished;
}

}  // namespace tenon
