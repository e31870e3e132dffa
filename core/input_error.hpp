// InputError: something a user wrote makes no sense, and where it stands.
//
// what() is one line, `FILE:LINE:COLUMN: what is wrong (what was expected)`; line and column count from 1 and are left out where they
// are 0, as for a file that is not there or an override from the command line.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tenon {

struct InputPosition {
  std::string file;
  int line = 0;    // from 1; 0: not known
  int column = 0;  // from 1; 0: not known

  std::string text() const {
    std::string text = file;
    if (line > 0) text.append(":").append(std::to_string(line));
    if (line > 0 && column > 0) text.append(":").append(std::to_string(column));
    return text;
  }
};

class InputError : public std::runtime_error {
 public:
  InputError(InputPosition position, const std::string& what_is_wrong, const std::string& expected = "")
      : std::runtime_error(position.text() + ": " + what_is_wrong + (expected.empty() ? "" : " (expected " + expected + ")")),
        position_(std::move(position)) {}

  const InputPosition& position() const { return position_; }

 private:
  InputPosition position_;
};

}  // namespace tenon
