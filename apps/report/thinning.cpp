#include "tenon/apps/report/thinning.hpp"

#include <algorithm>
#include <numeric>

namespace tenon {

namespace {

constexpr int kFewestIntervals = 50;

/// Rows that stay whatever the number of intervals.
void keep_changes(const CsvTable& record, const std::vector<double>& event_times, std::vector<bool>& keep) {
  const auto keep_both_sides = [&](const auto& values) {
    for (std::size_t k = 1; k < values.size(); ++k) {
      if (values[k] != values[k - 1]) keep[k] = keep[k - 1] = true;
    }
  };
  for (std::size_t c = 0; c < record.names.size(); ++c) {
    if (!record.texts[c].empty()) keep_both_sides(record.texts[c]);
    if (record.names[c].starts_with("mode_")) keep_both_sides(record.columns[c]);
  }
  const std::vector<double>& t = record["t"];
  for (const double time : event_times) {
    const auto [before, after] = std::equal_range(t.begin(), t.end(), time);
    const auto first = std::max<std::ptrdiff_t>(0, before - t.begin() - 1), last = std::min<std::ptrdiff_t>(std::ssize(t) - 1, after - t.begin());
    for (std::ptrdiff_t k = first; k <= last; ++k) keep[static_cast<std::size_t>(k)] = true;
  }
  keep.front() = keep.back() = true;
}

std::vector<int> rows_of_intervals(const CsvTable& record, std::vector<bool> keep, int intervals) {
  const auto rows = static_cast<std::size_t>(record.rows()), count = static_cast<std::size_t>(intervals);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * rows / count, end = (i + 1) * rows / count;
    if (begin == end) continue;
    keep[begin] = true;
    for (const std::vector<double>& column : record.columns) {
      if (column.empty()) continue;
      const auto [least, greatest] =
          std::minmax_element(column.begin() + static_cast<std::ptrdiff_t>(begin), column.begin() + static_cast<std::ptrdiff_t>(end));
      keep[static_cast<std::size_t>(least - column.begin())] = true;
      keep[static_cast<std::size_t>(greatest - column.begin())] = true;
    }
  }
  std::vector<int> kept;
  for (std::size_t k = 0; k < rows; ++k) {
    if (keep[k]) kept.push_back(static_cast<int>(k));
  }
  return kept;
}

}  // namespace

std::vector<int> thinned_rows(const CsvTable& record, const std::vector<double>& event_times, std::size_t max_values) {
  const std::size_t limit = max_values / record.names.size();
  if (static_cast<std::size_t>(record.rows()) <= limit) {
    std::vector<int> all(static_cast<std::size_t>(record.rows()));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::vector<bool> keep(static_cast<std::size_t>(record.rows()), false);
  keep_changes(record, event_times, keep);
  for (int intervals = static_cast<int>(limit);; intervals = intervals * 2 / 3) {
    std::vector<int> kept = rows_of_intervals(record, keep, intervals);
    if (kept.size() <= limit || intervals <= kFewestIntervals) return kept;
  }
}

}  // namespace tenon
