#include "tenon/apps/comma_list.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace tenon {

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<double> parse_numbers(const std::string& flag, const std::string& text, std::size_t size) {
  std::vector<double> numbers;
  for (const std::string& part : split_list(text)) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("{} has the entry '{}' (expected {} finite numbers, separated by commas)", flag, part, size));
    }
    numbers.push_back(value);
  }
  if (numbers.size() != size) throw std::invalid_argument(fmt::format("{} has {} entries (expected {})", flag, numbers.size(), size));
  return numbers;
}

}  // namespace tenon
