#include "tenon/apps/report/report.hpp"

#include <filesystem>
#include <stdexcept>

#include "tenon/apps/report/record_table.hpp"
#include "tenon/apps/report/scenery_file.hpp"
#include "tenon/apps/report/table_json.hpp"
#include "tenon/apps/report/thinning.hpp"
#include "tenon/core/embedded_file.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_page();  // generated from bundle/page.html

namespace {

constexpr std::size_t kMaxValues = 450'000;   // of a trajectory: 2.4 MB as base64
constexpr int kMaxIterations = 5000;          // of a trace

/// A trajectory with what belongs to it; any other record stands alone.
struct Part {
  CsvTable table;
  RecordKind kind;
  std::optional<CsvTable> events, fast_phases;
};

void check_time(const CsvTable& table) {
  const std::vector<double>& t = table["t"];
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (t[k] < t[k - 1]) throw InputError({table.file, table.lines[k], 1}, "the time goes back", "a time that never falls");
  }
}

std::vector<Part> read_parts(const std::vector<std::string>& files) {
  std::vector<Part> parts;
  for (const std::string& file : files) {
    CsvTable table = read_record(file);
    const RecordKind kind = record_kind(table);
    const bool belongs = kind == RecordKind::events || kind == RecordKind::fast_phases;
    if (table.rows() == 0 && belongs) continue;  // a run in which nothing touched
    if (table.rows() == 0) throw InputError({file, 2, 1}, "there is no row below the header", "rows of numbers");
    if (!belongs) {
      if (kind == RecordKind::trajectory) check_time(table);
      parts.push_back({std::move(table), kind, {}, {}});
      continue;
    }
    if (parts.empty() || parts.back().kind != RecordKind::trajectory) {
      throw InputError({file, 0, 0}, "these events follow no trajectory", "the file of their trajectory before them");
    }
    (kind == RecordKind::events ? parts.back().events : parts.back().fast_phases) = std::move(table);
  }
  return parts;
}

Json trajectory_json(const Part& part) {
  const std::vector<double> event_times = part.events ? (*part.events)["t"] : std::vector<double>();
  Json json = table_json(part.table, thinned_rows(part.table, event_times, kMaxValues));
  if (const std::optional<Json> scenery = read_scenery(part.table)) json.set("scenery", *scenery);
  if (part.events) json.set("events", table_json(*part.events));
  if (part.fast_phases) json.set("fast_phases", table_json(*part.fast_phases));
  return json;
}

Json part_json(const Part& part) {
  switch (part.kind) {
    case RecordKind::trajectory: return trajectory_json(part).set("kind", "trajectory");
    case RecordKind::trace: return table_json(part.table, longest_solves(part.table, kMaxIterations), "index").set("kind", "trace");
    case RecordKind::comparison: return table_json(part.table).set("kind", "comparison");
    case RecordKind::profile: return table_json(part.table).set("kind", "profile");
    case RecordKind::frequency: return table_json(part.table).set("kind", "frequency");
    case RecordKind::sphere: return table_json(part.table).set("kind", "sphere");
    case RecordKind::sweep: return table_json(part.table).set("kind", "sweep");
    case RecordKind::events:
    case RecordKind::fast_phases: break;  // part of their trajectory
  }
  throw std::logic_error(part.table.file + ": a record that stands in no part of its own");
}

std::string escaped_for_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

/// JSON in which no text can end the <script> that holds it or begin a comment: "<" occurs in its strings alone, as \u003c.
std::string escaped_for_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

/// Copies the template and fills its places, in the order in which they stand there.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& places) {
  std::string out;
  for (const auto& [place, text] : places) {
    const std::size_t at = page.find(place);
    if (at == std::string_view::npos) throw std::logic_error("the report's template lacks " + std::string(place));
    out.append(page.substr(0, at)).append(text);
    page.remove_prefix(at + place.size());
  }
  return out.append(page);
}

}  // namespace

std::string report_page(const std::vector<std::string>& files) {
  const std::vector<Part> parts = read_parts(files);
  Json list = Json::array();
  for (const Part& part : parts) list.push(part_json(part));
  const std::string title = escaped_for_html(std::filesystem::path(files.front()).stem().string());
  const std::string data = escaped_for_script(Json::object().set("schema", 1).set("parts", list).compact_text());
  return filled(embedded_page().front().text, {{"REPORT_TITLE", title}, {"REPORT_TITLE", title}, {"REPORT_DATA", data}});
}

void write_report(const std::vector<std::string>& files, const std::string& output) {
  const std::string page = report_page(files);
  OutputFile file(output);
  file.append(page);
  file.finish();
}

}  // namespace tenon
