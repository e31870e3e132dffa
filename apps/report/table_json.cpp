#include "tenon/apps/report/table_json.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>

namespace tenon {

namespace {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian floats");

constexpr std::size_t kSmallTable = 20'000;  // values

template <class Value>
std::string base64(const std::vector<Value>& values) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes(values.size() * sizeof(Value));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t word = (std::uint32_t{bytes[i]} << 16) | (left > 1 ? std::uint32_t{bytes[i + 1]} << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += kDigits[word >> 18];
    text += kDigits[word >> 12 & 63];
    text += left > 1 ? kDigits[word >> 6 & 63] : '=';
    text += left > 2 ? kDigits[word & 63] : '=';
  }
  return text;
}

template <class Value>
std::vector<Value> chosen(const std::vector<Value>& values, const std::vector<int>& rows) {
  std::vector<Value> out;
  out.reserve(rows.size());
  for (const int row : rows) out.push_back(values[static_cast<std::size_t>(row)]);
  return out;
}

bool fits_single(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return !(std::abs(v) > std::numeric_limits<float>::max()); });
}

void set_numbers(Json& column, const std::vector<double>& values, bool precise) {
  if (std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); }))
    column.set("constant", values.front());
  else if (precise || !fits_single(values))
    column.set("f64", base64(values));
  else
    column.set("f32", base64(std::vector<float>(values.begin(), values.end())));
}

/// Every distinct text once, in the order of their first rows.
void set_texts(Json& column, const std::vector<std::string>& values) {
  std::map<std::string, std::uint32_t> index;
  std::vector<std::string> texts;
  std::vector<std::uint32_t> codes;
  for (const std::string& text : values) {
    const auto [at, is_new] = index.emplace(text, static_cast<std::uint32_t>(texts.size()));
    if (is_new) texts.push_back(text);
    codes.push_back(at->second);
  }
  column.set("texts", texts).set("codes", base64(codes));
}

}  // namespace

Json table_json(const CsvTable& table, const std::vector<int>& rows, std::string_view precise) {
  const bool is_small = rows.size() * table.names.size() <= kSmallTable;
  Json columns = Json::array();
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    Json column = Json::object();
    column.set("name", table.names[k]);
    if (table.texts[k].empty())
      set_numbers(column, chosen(table.columns[k], rows), is_small || table.names[k] == precise);
    else
      set_texts(column, chosen(table.texts[k], rows));
    columns.push(column);
  }
  return Json::object()
      .set("name", std::filesystem::path(table.file).filename().string())
      .set("rows", static_cast<long>(table.rows()))
      .set("kept", static_cast<long>(rows.size()))
      .set("columns", columns);
}

Json table_json(const CsvTable& table) {
  std::vector<int> rows(static_cast<std::size_t>(table.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  return table_json(table, rows);
}

}  // namespace tenon
