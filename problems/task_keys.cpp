#include "tenon/problems/task_keys.hpp"

#include <fmt/format.h>

namespace tenon {

using toml_file::Table;

namespace {

template <class Number>
Number checked(const Table& table, const std::string& key, Number value, bool good, const std::string& expected) {
  if (!good) throw InputError(table.position(key), fmt::format("{} is {}", key, value), expected);
  return value;
}

}  // namespace

Table required_table(const Table& root, const std::string& key, const std::vector<std::string>& known_keys) {
  const auto table = root.table(key, known_keys);
  if (!table) throw InputError(root.position(), "there is no table '" + key + "'", "[" + key + "]");
  return *table;
}

double positive(const Table& table, const std::string& key, double fallback) {
  const double value = table.number(key, fallback);
  return checked(table, key, value, value > 0, "more than 0");
}

double not_negative(const Table& table, const std::string& key, double fallback) {
  const double value = table.number(key, fallback);
  return checked(table, key, value, value >= 0, "0 or more");
}

int positive_integer(const Table& table, const std::string& key, int fallback) {
  const int value = table.integer(key, fallback);
  return checked(table, key, value, value > 0, "1 or more");
}

}  // namespace tenon
