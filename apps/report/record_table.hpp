// A table as a record holds it: columns of numbers or of texts, and what kind of record its columns make it.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/csv.hpp"

namespace tenon {

/// What a file of columns can be, by the columns that tell:
enum class RecordKind {
  events,       // t, contact, from, to
  fast_phases,  // t, contact, tau: collisions in their own time
  comparison,   // problem, solver, status
  profile,      // cost, ratio: performance profiles, one column for each solver
  frequency,    // frequency: quantities over it, on logarithmic axes
  sphere,       // nx, ny, nz: quantities over unit directions
  sweep,        // success: samples of a Monte Carlo
  trajectory,   // t
  trace,        // from JSON lines: index, the iterations of a solve
};

/// Throws InputError where the columns tell of no kind.
RecordKind record_kind(const CsvTable& table);

/// Reads CSV with texts, or a trace of JSON lines (a name that ends with .jsonl; null is NaN). Throws InputError.
CsvTable read_record(const std::string& file);

/// The rows of the iterations that a page carries of a long trace: those of the rows (of a log) that took most iterations, at most `limit`.
std::vector<int> longest_solves(const CsvTable& trace, int limit);

}  // namespace tenon
