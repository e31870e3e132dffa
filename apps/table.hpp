// A table of words for people: columns as wide as they need to be, numbers to the right.
#pragma once

#include <string>
#include <vector>

namespace tenon {

class Table {
 public:
  explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  /// One line for each row, the header first; a column is set to the right where all its cells below the header begin as numbers do.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A time with a unit that suits it: "1.23 us".
std::string duration_text(double seconds);

}  // namespace tenon
