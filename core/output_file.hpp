// OutputFile: a file that is there as a whole or not at all.
//
// Records go to FILE.partial, which takes the name FILE on finish(). Whatever ends the program early, FILE.partial holds complete records
// only, and an older FILE is as it was. A target that is no regular file (a pipe, a device, "-" for standard output) is written directly.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace tenon {

/// Output that cannot be written: full disk, no permission. what() names the file and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class OutputFile {
 public:
  /// Opens FILE.partial. Throws InputError where the folder is not there or FILE is one, OutputError where it cannot be opened.
  explicit OutputFile(std::string path);
  /// Flushes what is complete, without a word where that fails. Unless finish() was called FILE.partial stays, where it has any record.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends one complete record, its newline included. Throws OutputError.
  void append(std::string_view record);
  /// Writes what is still in memory. Throws OutputError.
  void flush();
  /// Flushes, closes, renames FILE.partial to FILE. Throws OutputError.
  void finish();

  const std::string& path() const { return path_; }
  /// Where the records stand until finish(): FILE.partial, or FILE itself where it is no regular file.
  const std::string& partial_path() const { return partial_path_; }

 private:
  [[noreturn]] void fail(int error);

  std::string path_, partial_path_;
  int descriptor_ = -1;
  bool is_started_ = false;
  long written_ = 0;    // bytes of complete records in the file
  std::string buffer_;  // complete records not yet written
};

/// Whether that target is no regular file: it is written directly, without FILE.partial.
bool is_written_directly(const std::string& path);

/// Throws as the constructor of OutputFile would, without opening anything: so that a long job does not find out at its end.
void check_output_path(const std::string& path);

}  // namespace tenon
