// The rows of a sweep on disk: in the order in which they come while it runs, sorted by seed at its end.
//
// FILE.partial grows by one complete row at a time, so that whatever ends the program early loses only what was under way; FILE.sweep.json
// beside it says what the rows belong to, so that --resume does not mix two sweeps.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tenon/core/csv.hpp"
#include "tenon/core/eigen.hpp"

namespace tenon {

class SweepRecord {
 public:
  /// An empty path keeps the rows in memory alone. `identity`: scene, overrides, solver as one JSON object. With `resume` the rows of an earlier
  /// FILE.partial are taken over. Throws InputError where those belong to another sweep, or cannot be read; as OutputFile does.
  SweepRecord(std::string path, std::vector<std::string> names, const std::string& identity, bool resume);

  /// A seed that is there already is left as it is. Throws OutputError.
  void add(std::uint64_t seed, const Vector& row);
  /// Writes FILE, sorted. Throws OutputError.
  void finish();

  const std::map<std::uint64_t, Vector>& rows() const { return rows_; }
  const std::vector<std::string>& names() const { return names_; }
  std::string partial_path() const { return path_ + ".partial"; }

 private:
  void take_over(const std::string& partial);
  std::string aside_path() const { return path_ + ".partial.aside"; }  // rows of before, while they are written anew
  void write(CsvWriter& csv, std::uint64_t seed, const Vector& row) const;

  std::string path_;
  std::vector<std::string> names_;
  std::map<std::uint64_t, Vector> rows_;
  std::optional<CsvWriter> arrivals_;
};

}  // namespace tenon
