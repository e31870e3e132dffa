// A problem from an AMPL .nl file, text or binary.
//
// The file is checked as a whole (nl_scan.hpp), then the AMPL solver library reads the same bytes and evaluates. A maximisation becomes the
// minimisation of -f; suffixes are ignored; names come from the .col and .row files where they lie beside.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/point.hpp"

namespace tenon {

struct NlFile {
  std::unique_ptr<Nlp> problem;
  Point start;              // the file's guess, 0 where it has none; its multipliers in our sign; z = 0
  bool maximises = false;   // the problem is then min -f
  int objective = 0;        // which of the file's objectives it is, from 1; 0: none
  std::vector<int> options;       // what a .sol file repeats
  double boundary_tolerance = 0;  // likewise, where options[1] is 3
};

/// Whether the AMPL solver library was there at the time of the build; without it the functions below refuse every good file.
bool nl_files_are_available();

/// Reads PATH with the objective of that number (from 1; 0: none, any feasible point will do). Throws InputError where the file cannot be
/// read or does not make sense, std::invalid_argument where it has no such objective, or where the AMPL solver library was absent at the
/// time of the build.
NlFile read_nl(const std::string& path, int objective = 1);

/// The same from memory; `path` is the name in messages, and .col and .row files are looked for beside it.
NlFile parse_nl(const std::string& bytes, const std::string& path, int objective = 1);

}  // namespace tenon
