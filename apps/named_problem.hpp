// A problem as the command line names it: a built-in name, a .nl file, or the dump of a failed solve.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tenon/apps/measure.hpp"

namespace tenon {

struct NamedProblem {
  std::string name;  // as on the command line
  std::unique_ptr<Nlp> problem;
  Point start;
  bool maximises = false;  // the file does, and the problem is min -f
  std::optional<double> published_objective;
  Options options;  // those of a dump; the usual ones otherwise

  std::string built_in;  // what a dump needs to be whole: the built-in name,
  std::string nl_bytes;  // or the bytes of the file
};

/// Throws InputError for a file that cannot be read or makes no sense, std::invalid_argument for a name that is not known.
NamedProblem load_problem(const std::string& name);

/// From a built-in name, or from the bytes of a .nl file.
NamedProblem built_in_problem(const std::string& name);
NamedProblem nl_problem(const std::string& bytes, const std::string& path);

/// As the other measure(), from the problem's own start; the objective is the file's, not its negative.
Measurement measure(const NamedProblem& named, const std::string& solver, const Options& options, int timed_runs);

}  // namespace tenon
