#include "tenon/apps/row_comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "tenon/apps/result_json.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/apps/table.hpp"

namespace tenon {

namespace {

constexpr double kAgreement = 1e-6;  // relative, of objectives
constexpr std::size_t kNamedRows = 20;

template <class Cells, class Value>
std::vector<double> each(const Cells& cells, Value value) {
  std::vector<double> values;
  for (const auto& cell : cells) values.push_back(static_cast<double>(value(cell)));
  return values;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

template <class Cells>
std::map<Status, long> count(const Cells& cells) {
  std::map<Status, long> by_status;
  for (const auto& cell : cells) ++by_status[cell.status];
  return by_status;
}

/// Relative.
double above(double objective, double lowest) {
  return (objective - lowest) / std::max(std::abs(lowest), std::numeric_limits<double>::min());
}

}  // namespace

void RowComparison::add(std::size_t solver, const Measurement& m) {
  Column& column = columns_[solver];
  column.refusal = m.refusal;
  if (!m.refusal.empty()) return;
  column.cells.push_back({m.result.status, m.result.objective, m.result.residual.max(), m.result.residual.primal, m.time, m.result.iterations});
  EvaluationCounts& sum = column.counts;
  sum.prepare += m.counts.prepare, sum.objective += m.counts.objective, sum.gradient += m.counts.gradient;
  sum.constraints += m.counts.constraints, sum.jacobian += m.counts.jacobian, sum.hessian += m.counts.hessian;
}

std::vector<double> RowComparison::lowest() const {
  std::vector<double> lowest;
  for (const Column& column : columns_) {
    lowest.resize(std::max(lowest.size(), column.cells.size()), std::numeric_limits<double>::infinity());
    for (std::size_t r = 0; r < column.cells.size(); ++r) {
      if (column.cells[r].primal <= feasible_) lowest[r] = std::min(lowest[r], column.cells[r].objective);
    }
  }
  return lowest;
}

std::vector<RowComparison::Stray> RowComparison::strays(const Column& column, const std::vector<double>& lowest) const {
  std::vector<Stray> out;
  for (std::size_t r = 0; r < column.cells.size(); ++r) {
    const Cell& cell = column.cells[r];
    if (above(cell.objective, lowest[r]) <= kAgreement && cell.primal <= feasible_) continue;
    out.push_back({r, succeeded(cell.status) && cell.primal <= feasible_});
  }
  return out;
}

double RowComparison::furthest(const Column& column, const std::vector<double>& lowest) const {
  double furthest = 0;
  for (std::size_t r = 0; r < column.cells.size(); ++r) {
    if (column.cells[r].primal <= feasible_) furthest = std::max(furthest, above(column.cells[r].objective, lowest[r]));
  }
  return furthest;
}

std::string RowComparison::text() const {
  const std::vector<double> best = lowest();
  Table table({"solver", "solved", "acceptable", "not", "agree", "above best", "residual", "iterations", "evaluations", "time"});
  std::string below;
  for (const Column& column : columns_) {
    if (!column.refusal.empty()) {
      table.add({column.solver, "-", "-", "-", "-", "not taken", "-", "-", "-", "-"});
      below += fmt::format("{}: {}\n", column.solver, column.refusal);
      continue;
    }
    const auto& cells = column.cells;
    const std::map<Status, long> by_status = count(cells);
    long failed = 0;
    std::vector<std::string> failures;
    for (const auto& [status, times] : by_status) {
      if (succeeded(status)) continue;
      failed += times;
      failures.push_back(fmt::format("{} {}", times, to_string(status)));
    }
    if (failed > 0) below += fmt::format("{}: {}\n", column.solver, fmt::join(failures, ", "));

    const auto residuals = each(cells, [](const Cell& c) { return c.residual; });
    const auto iterations = each(cells, [](const Cell& c) { return c.iterations; });
    const auto times = each(cells, [](const Cell& c) { return c.time; });
    const std::vector<Stray> stray = strays(column, best);
    const auto per_row = [&](long sum) { return fmt::format("{:.1f}", static_cast<double>(sum) / static_cast<double>(cells.size())); };
    const EvaluationCounts& e = column.counts;
    const auto rows_with = [&](Status status) { return fmt::format("{}", by_status.contains(status) ? by_status.at(status) : 0); };
    table.add({column.solver, rows_with(Status::solved), rows_with(Status::acceptable), fmt::format("{}", failed),
               fmt::format("{}", cells.size() - stray.size()), fmt::format("{:.1e}", furthest(column, best)),
               fmt::format("{:.1e} / {:.1e}", percentile(residuals, 1), median(residuals)),
               fmt::format("{} / {} / {}", median(iterations), percentile(iterations, 0.99), sum(iterations)),
               fmt::format("{}/{}/{}/{}/{}", per_row(e.objective), per_row(e.gradient), per_row(e.constraints), per_row(e.jacobian),
                           per_row(e.hessian)),
               fmt::format("{} / {}", duration_text(median(times)), duration_text(percentile(times, 0.99)))});
    for (const bool stationary : {true, false}) {
      std::vector<std::size_t> rows;
      for (const Stray& s : stray) {
        if (s.stationary == stationary) rows.push_back(s.row + 1);
      }
      if (rows.empty()) continue;
      const std::size_t more = rows.size() - std::min(rows.size(), kNamedRows);
      rows.resize(rows.size() - more);
      below += fmt::format("{}: {} in row{} {}{}\n", column.solver,
                           stationary ? "a stationary point of a higher objective" : "no solution", rows.size() == 1 ? "" : "s",
                           fmt::join(rows, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
    }
  }
  return table.text() + (below.empty() ? "" : "\n") + below;
}

Json RowComparison::json() const {
  const std::vector<double> best = lowest();
  Json list = Json::array();
  for (const Column& column : columns_) {
    Json json = Json::object();
    json.set("solver", column.solver);
    if (!column.refusal.empty()) {
      list.push(json.set("refusal", column.refusal));
      continue;
    }
    Json statuses = Json::object();
    for (const auto& [status, rows] : count(column.cells)) statuses.set(std::string(to_string(status)), rows);

    const std::vector<Stray> stray = strays(column, best);
    Json elsewhere = Json::array();
    for (const Stray& s : stray) {
      const Cell& cell = column.cells[s.row];
      elsewhere.push(Json::object()
                         .set("row", static_cast<long>(s.row) + 1)
                         .set("status", to_string(cell.status))
                         .set("objective", cell.objective)
                         .set("lowest", best[s.row])
                         .set("residual", cell.residual)
                         .set("stationary", s.stationary));
    }
    const auto spread = [&](auto value) {
      const std::vector<double> values = each(column.cells, value);
      return Json::object()
          .set("median", median(values))
          .set("p99", percentile(values, 0.99))
          .set("max", percentile(values, 1))
          .set("sum", sum(values));
    };
    list.push(json.set("status", statuses)
                  .set("above_best", furthest(column, best))
                  .set("agree", static_cast<long>(column.cells.size() - stray.size()))
                  .set("elsewhere", elsewhere)
                  .set("residual", spread([](const Cell& c) { return c.residual; }))
                  .set("iterations", spread([](const Cell& c) { return c.iterations; }))
                  .set("evaluations", evaluations_json(column.counts))
                  .set("time_s", spread([](const Cell& c) { return c.time; }))
                  .set("objectives", each(column.cells, [](const Cell& c) { return c.objective; })));
  }
  return list;
}

}  // namespace tenon
