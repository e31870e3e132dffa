#include "tenon/problems/nl/sol_file.hpp"

#include <charconv>

namespace tenon {

namespace {

constexpr int kFewestOptions = 3;  // fewer are not repeated
constexpr int kWithTolerance = 3;  // what the second option says where a tolerance follows

void append_line(std::string& text, int value) {
  text += std::to_string(value) + "\n";
}

/// The shortest digits that read back to the same number.
void append_line(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  text += "\n";
}

}  // namespace

int ampl_code(Status status) {
  switch (status) {
    case Status::solved: return 0;
    case Status::acceptable: return 100;
    case Status::infeasible: return 200;
    case Status::unbounded: return 300;
    case Status::iteration_limit: return 400;
    case Status::time_limit: return 401;
    case Status::stopped: return 402;
    case Status::invalid_start:
    case Status::numerical_failure: return 500;
  }
  return 500;
}

std::string sol_text(const NlFile& file, const Point& point, Status status, const std::string& message) {
  const int n = static_cast<int>(point.x.size()), m = static_cast<int>(point.lambda.size());
  std::string text = message + "\n\n";
  if (const int count = static_cast<int>(file.options.size()); count >= kFewestOptions) {
    const bool has_tolerance = file.options[1] == kWithTolerance;
    text += "Options\n";
    append_line(text, has_tolerance ? count + 2 : count);
    for (const int option : file.options) append_line(text, option);
    for (const int size : {m, m, n, n}) append_line(text, size);
    if (has_tolerance) append_line(text, file.boundary_tolerance);
  }
  for (const double lambda : point.lambda) append_line(text, file.maximises ? lambda : 0 - lambda);  // 0, not -0
  for (const double x : point.x) append_line(text, x);
  return text + "objno " + std::to_string(file.objective - 1) + " " + std::to_string(ampl_code(status)) + "\n";
}

}  // namespace tenon
