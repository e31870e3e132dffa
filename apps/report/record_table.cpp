#include "tenon/apps/report/record_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tenon/apps/json.hpp"
#include "tenon/core/read_file.hpp"

namespace tenon {

namespace {

struct Signature {
  RecordKind kind;
  std::vector<std::string> columns;
};

/// The first whose columns are all there.
const std::vector<Signature>& signatures() {
  static const std::vector<Signature> table{
      {RecordKind::events, {"t", "contact", "from", "to"}},   {RecordKind::fast_phases, {"t", "contact", "tau"}},
      {RecordKind::comparison, {"problem", "solver", "status"}}, {RecordKind::profile, {"cost", "ratio"}},
      {RecordKind::sphere, {"nx", "ny", "nz"}},               {RecordKind::sweep, {"success"}},
      {RecordKind::trajectory, {"t"}},                           {RecordKind::frequency, {"frequency"}},
  };
  return table;
}

std::string first_columns(const CsvTable& table) {
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(6, table.names.size()); ++k) text += (k > 0 ? "," : "") + table.names[k];
  return text + (table.names.size() > 6 ? ",..." : "");
}

Json parse_line(const std::string& text, const std::string& file, int line) {
  try {
    return Json::parse(text, file, "one JSON object for each iteration");
  } catch (const InputError& error) {
    throw InputError({file, line, error.position().column}, "this is no JSON", "one JSON object for each iteration");
  }
}

CsvTable read_trace(const std::string& file) {
  CsvTable table;
  table.file = file;
  const std::string text = read_file(file);
  int line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string content = text.substr(begin, end - begin);
    begin = end + 1;
    ++line;
    if (content.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Json iteration = parse_line(content, file, line);
    if (table.names.empty()) {
      table.names = iteration.keys();
      table.columns.resize(table.names.size());
      table.texts.resize(table.names.size());
    }
    for (std::size_t k = 0; k < table.names.size(); ++k) {
      if (!iteration.has(table.names[k])) throw InputError({file, line, 0}, "'" + table.names[k] + "' is missing", "the keys of the first line");
      const Json value = iteration.at(table.names[k]);
      table.columns[k].push_back(value.is_number() ? value.number() : std::nan(""));
    }
    table.lines.push_back(line);
  }
  if (!table.has("index")) throw InputError({file, 1, 0}, "there is no 'index'", "a trace: one JSON object for each iteration");
  return table;
}

}  // namespace

RecordKind record_kind(const CsvTable& table) {
  if (table.file.ends_with(".jsonl")) return RecordKind::trace;
  for (const Signature& signature : signatures()) {
    if (std::all_of(signature.columns.begin(), signature.columns.end(), [&](const std::string& name) { return table.has(name); })) {
      return signature.kind;
    }
  }
  throw InputError({table.file, 1, 1}, "the columns " + first_columns(table) + " are of no record that a report knows",
                   "one with a time t or a frequency, or a comparison, a profile, a sweep or a map over directions");
}

CsvTable read_record(const std::string& file) {
  return file.ends_with(".jsonl") ? read_trace(file) : read_csv(file, {{}, {}, true});
}

std::vector<int> longest_solves(const CsvTable& trace, int limit) {
  const std::vector<double>* row = trace.find("row");
  std::vector<int> kept;
  if (row == nullptr || trace.rows() <= limit) {
    for (int k = 0; k < std::min(limit, trace.rows()); ++k) kept.push_back(k);
    return kept;
  }
  std::map<double, int> iterations;
  for (const double r : *row) ++iterations[r];
  std::vector<std::pair<int, double>> by_length;
  for (const auto& [r, count] : iterations) by_length.emplace_back(-count, r);
  std::sort(by_length.begin(), by_length.end());
  std::map<double, bool> chosen;
  for (int sum = 0; const auto& [negative_count, r] : by_length) {
    sum -= negative_count;
    if (sum > limit) break;
    chosen[r] = true;
  }
  for (int k = 0; k < trace.rows(); ++k) {
    if (chosen.contains((*row)[static_cast<std::size_t>(k)])) kept.push_back(k);
  }
  return kept;
}

}  // namespace tenon
