#include "tenon/apps/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace tenon {

namespace {

bool is_like_a_number(const std::string& cell) {
  if (cell.empty()) return true;
  const std::size_t first = cell[0] == '-' || cell[0] == '+' ? 1 : 0;
  return cell.size() > first ? std::isdigit(static_cast<unsigned char>(cell[first])) != 0 || cell.substr(first) == "inf" : true;
}

}  // namespace

std::string Table::text() const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> width(columns, 0);
  std::vector<bool> right(columns, true);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t k = 0; k < std::min(columns, rows_[r].size()); ++k) {
      width[k] = std::max(width[k], rows_[r][k].size());
      if (r > 0 && !is_like_a_number(rows_[r][k])) right[k] = false;
    }
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t k = 0; k < std::min(columns, row.size()); ++k) {
      line += right[k] ? fmt::format("{:>{}}", row[k], width[k]) : fmt::format("{:<{}}", row[k], width[k]);
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string duration_text(double seconds) {
  const double magnitude = std::abs(seconds);
  if (magnitude < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (magnitude < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (magnitude < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

}  // namespace tenon
