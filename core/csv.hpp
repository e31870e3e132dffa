// Tables of numbers as comma-separated text: a header line of names, then one row per line.
//
// Numbers are written as %.17g, so that a file reads back bit for bit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tenon/core/input_error.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

/// The columns that were asked for, as they stand in a file.
struct CsvTable {
  std::string file;
  std::vector<std::string> names;            // of the columns read
  std::vector<std::vector<double>> columns;  // columns[k][row], as long as rows()
  std::vector<std::vector<std::string>> texts;  // texts[k][row] in place of columns[k] where column k holds texts, see CsvColumns
  std::vector<int> lines;                    // line of each row in the file, from 1

  int rows() const { return static_cast<int>(lines.size()); }
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The values of a column, or null where the file does not have it.
  const std::vector<double>* find(std::string_view name) const;
  /// The values of a column that is there.
  const std::vector<double>& operator[](std::string_view name) const;
};

/// Which columns to read; all others are skipped, whatever stands in them. With both lists empty, or with texts, every column is read.
struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional;
  bool texts = false;  // as records have them: a column whose first cell is no number holds texts, an empty cell of another is NaN, no rows are rows
};

/// Reads a file. Throws InputError at the first thing that is wrong: a file that cannot be read or is empty, a required column that is
/// missing, a name that stands twice, a row that is shorter or longer than the header, a cell that is no finite number, no row at all.
CsvTable read_csv(const std::string& file, const CsvColumns& columns = {});

/// The same from text; `file` is the name used in messages.
CsvTable parse_csv(std::string_view text, const std::string& file, const CsvColumns& columns = {});

/// Writes a table row by row. Whatever ends the program, what stands in the file (see OutputFile) is complete rows.
class CsvWriter {
 public:
  /// Opens the file and writes the header. Throws as OutputFile does.
  CsvWriter(std::string path, const std::vector<std::string>& names);

  /// One cell; end_row() closes the row and throws std::logic_error where it has not as many cells as the header.
  CsvWriter& operator<<(double value);
  CsvWriter& operator<<(int value);
  CsvWriter& operator<<(std::string_view text);  // a plain word: no comma, quote or newline
  void end_row();

  /// What was written so far is on the disk, whatever happens next. Throws OutputError.
  void flush() { file_.flush(); }
  /// Only now does the file take its name. Throws OutputError.
  void finish() { file_.finish(); }

  long rows() const { return rows_; }
  const OutputFile& file() const { return file_; }

 private:
  void begin_cell();

  OutputFile file_;
  std::string row_;
  std::size_t width_ = 0, cells_ = 0;
  long rows_ = 0;
};

}  // namespace tenon
