#include "tenon/problems/toml/checked_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

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

Eigen::Vector2d centre_and_deviation(const Table& table, const std::string& key, const std::string& centre) {
  const Eigen::Vector2d pair(table.numbers(key, 2).data());
  if (!(pair.minCoeff() > 0)) {
    throw InputError(table.position(key), "a " + centre + " or a deviation that is not positive", "[" + centre + ", deviation], both more than 0");
  }
  return pair;
}

std::vector<std::string> with_parameters(std::vector<std::string> overrides, const std::vector<std::string>& root_keys) {
  for (std::string& text : overrides) {
    const std::string key = text.substr(0, text.find('='));
    const bool is_path = key.empty() || key.find('.') != std::string::npos || std::ranges::count(root_keys, key) > 0;
    if (!is_path) text.insert(0, "parameters.");
  }
  return overrides;
}

}  // namespace tenon
