#include "tenon/core/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

#include "tenon/core/read_file.hpp"

namespace tenon {

namespace {

struct Cell {
  std::string_view text;  // without surrounding blanks and quotes
  int column = 1;         // of its first character in the line, from 1
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Splits a line at its commas; a comma between double quotes does not count.
void split(std::string_view line, std::vector<Cell>& cells) {
  cells.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != ',')) continue;
    const std::string_view raw = line.substr(begin, i - begin);
    std::string_view text = trimmed(raw);
    const auto column = static_cast<int>(begin + (text.empty() ? 0 : static_cast<std::size_t>(text.data() - raw.data()))) + 1;
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    cells.push_back({text, column});
    begin = i + 1;
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

/// Parses a whole cell; std::errc::invalid_argument where it is no number.
std::errc parse_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

double number(const Cell& cell, const std::string& name, const InputPosition& position) {
  double value = 0;
  const std::errc error = parse_number(cell.text, value);
  const std::string what = "column '" + name + "' holds '" + std::string(cell.text) + "'";
  if (cell.text.empty()) throw InputError(position, "column '" + name + "' is empty", "a number");
  if (error == std::errc::result_out_of_range) throw InputError(position, what, "a number within the range of double precision");
  if (error != std::errc()) throw InputError(position, what, "a number");
  if (!std::isfinite(value)) throw InputError(position, what, "a finite number");
  return value;
}

/// Which cells of a row to read, from the header.
std::vector<std::size_t> chosen_columns(const std::vector<Cell>& header, int line, const CsvColumns& wanted, CsvTable& table) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const Cell& cell : header) {
    const std::string name(cell.text);
    if (name.empty()) throw InputError({table.file, line, cell.column}, "a column without a name", "a header line of column names");
    if (!seen.insert(name).second)
      throw InputError({table.file, line, cell.column}, "column '" + name + "' stands twice", "each name once");
    names.push_back(name);
  }
  for (const std::string& name : wanted.required) {
    if (!seen.contains(name)) {
      throw InputError({table.file, line, 1}, "column '" + name + "' is missing in '" + joined(names) + "'",
                       "at least the columns " + joined(wanted.required));
    }
  }
  const bool all = wanted.texts || (wanted.required.empty() && wanted.optional.empty());
  const auto is_wanted = [&](const std::string& name) {
    return all || std::count(wanted.required.begin(), wanted.required.end(), name) > 0 ||
           std::count(wanted.optional.begin(), wanted.optional.end(), name) > 0;
  };
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!is_wanted(names[k])) continue;
    chosen.push_back(k);
    table.names.push_back(names[k]);
  }
  table.columns.resize(chosen.size());
  table.texts.resize(chosen.size());
  return chosen;
}

}  // namespace

const std::vector<double>* CsvTable::find(std::string_view name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? nullptr : &columns[static_cast<std::size_t>(at - names.begin())];
}

const std::vector<double>& CsvTable::operator[](std::string_view name) const {
  const std::vector<double>* column = find(name);
  if (column == nullptr) throw std::invalid_argument(file + ": has no column '" + std::string(name) + "'");
  return *column;
}

CsvTable parse_csv(std::string_view text, const std::string& file, const CsvColumns& wanted) {
  CsvTable table;
  table.file = file;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);

  std::vector<Cell> cells;
  std::vector<std::size_t> chosen;
  std::size_t width = 0;
  for (int line = 1; !text.empty(); ++line) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trimmed(content).empty()) continue;
    split(content, cells);
    if (width == 0) {
      width = cells.size();
      chosen = chosen_columns(cells, line, wanted, table);
      continue;
    }
    if (cells.size() != width) {
      const int column = cells.size() > width ? cells[width].column : static_cast<int>(content.size()) + 1;
      throw InputError({file, line, column}, "the row has " + std::to_string(cells.size()) + " cells",
                       std::to_string(width) + ", as the header");
    }
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const Cell& cell = cells[chosen[k]];
      double value = 0;
      const bool is_first = table.lines.empty();
      const bool holds_texts = wanted.texts && (is_first ? !cell.text.empty() && parse_number(cell.text, value) == std::errc::invalid_argument
                                                         : !table.texts[k].empty());
      if (holds_texts)
        table.texts[k].emplace_back(cell.text);
      else
        table.columns[k].push_back(wanted.texts && cell.text.empty() ? std::nan("") : number(cell, table.names[k], {file, line, cell.column}));
    }
    table.lines.push_back(line);
  }
  if (width == 0) throw InputError({file, 1, 1}, "the file is empty", "a header line of column names and rows of numbers");
  if (table.lines.empty() && !wanted.texts) throw InputError({file, 2, 1}, "there is no row below the header", "rows of numbers");
  return table;
}

CsvTable read_csv(const std::string& file, const CsvColumns& columns) {
  return parse_csv(read_file(file), file, columns);
}

CsvWriter::CsvWriter(std::string path, const std::vector<std::string>& names) : file_(std::move(path)), width_(names.size()) {
  file_.append(joined(names) + "\n");
}

void CsvWriter::begin_cell() {
  if (cells_++ > 0) row_ += ',';
}

CsvWriter& CsvWriter::operator<<(double value) {
  begin_cell();
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17);
  row_.append(text, end);
  return *this;
}

CsvWriter& CsvWriter::operator<<(int value) {
  begin_cell();
  char text[16];
  row_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  return *this;
}

CsvWriter& CsvWriter::operator<<(std::string_view text) {
  begin_cell();
  row_ += text;
  return *this;
}

void CsvWriter::end_row() {
  if (cells_ != width_) {
    throw std::logic_error(file_.path() + ": a row of " + std::to_string(cells_) + " cells below a header of " + std::to_string(width_));
  }
  row_ += '\n';
  file_.append(row_);
  row_.clear();
  cells_ = 0;
  ++rows_;
}

}  // namespace tenon
