#include "tenon/apps/sweep/sweep_record.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

#include "tenon/core/input_error.hpp"
#include "tenon/core/read_file.hpp"

namespace tenon {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> with_seed(const std::vector<std::string>& names) {
  std::vector<std::string> columns{"seed"};
  columns.insert(columns.end(), names.begin(), names.end());
  return columns;
}

void write_identity(const std::string& file, const std::string& identity) {
  OutputFile out(file);
  out.append(identity);
  out.finish();
}

}  // namespace

SweepRecord::SweepRecord(std::string path, std::vector<std::string> names, const std::string& identity, bool resume)
    : path_(std::move(path)), names_(std::move(names)) {
  if (path_.empty() || is_written_directly(path_)) return;
  const std::string identity_file = path_ + ".sweep.json";
  if (resume && fs::exists(identity_file)) {
    if (read_file(identity_file) != identity) {
      throw InputError({identity_file, 1, 1}, "the rows beside it belong to another sweep", "the same scene, settings and solver, or no --resume");
    }
    for (const std::string& rows : {aside_path(), partial_path(), path_}) take_over(rows);
    if (fs::exists(partial_path())) fs::rename(partial_path(), aside_path());
  }
  write_identity(identity_file, identity);
  arrivals_.emplace(path_, with_seed(names_));
  for (const auto& [seed, row] : rows_) write(*arrivals_, seed, row);
  arrivals_->flush();
  fs::remove(aside_path());
}

// The last line may have been cut short, where the machine lost power.
void SweepRecord::take_over(const std::string& partial) {
  if (!fs::exists(partial)) return;
  std::string text = read_file(partial);
  text.resize(text.rfind('\n') + 1);
  if (text.empty()) return;
  const CsvTable table = parse_csv(text, partial, {.required = {}, .optional = {}, .texts = true});
  if (table.names != with_seed(names_)) throw InputError({partial, 1, 1}, "the columns are those of another sweep", "seed and those of this scene");
  for (std::size_t r = 0; r < table.lines.size(); ++r) {
    Vector row(static_cast<int>(names_.size()));
    for (std::size_t c = 0; c < names_.size(); ++c) row[static_cast<int>(c)] = table.columns[c + 1][r];
    rows_.emplace(static_cast<std::uint64_t>(table.columns[0][r]), std::move(row));
  }
}

void SweepRecord::add(std::uint64_t seed, const Vector& row) {
  if (!rows_.emplace(seed, row).second || !arrivals_) return;
  write(*arrivals_, seed, row);
  arrivals_->flush();
}

// A number that is none (the time to success of a run that failed) is an empty cell.
void SweepRecord::write(CsvWriter& csv, std::uint64_t seed, const Vector& row) const {
  csv << static_cast<double>(seed);
  for (const double value : row) {
    if (std::isfinite(value))
      csv << value;
    else
      csv << "";
  }
  csv.end_row();
}

void SweepRecord::finish() {
  if (path_.empty()) return;
  if (arrivals_) {
    arrivals_.reset();
    fs::rename(partial_path(), aside_path());
  }
  CsvWriter sorted(path_, with_seed(names_));
  for (const auto& [seed, row] : rows_) write(sorted, seed, row);
  sorted.finish();
  fs::remove(aside_path());
}

}  // namespace tenon
