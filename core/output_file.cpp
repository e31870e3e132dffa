#include "tenon/core/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "tenon/core/input_error.hpp"

namespace tenon {

namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

bool is_standard_output(const std::string& path) {
  return path == "-";
}

}  // namespace

bool is_written_directly(const std::string& path) {
  if (is_standard_output(path) || path.starts_with("/dev/")) return true;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void check_output_path(const std::string& path) {
  if (is_standard_output(path)) return;
  std::error_code error;
  const std::filesystem::path target(path);
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (path.empty() || !target.has_filename()) throw InputError({path, 0, 0}, "is no name for an output file", "a file name");
  if (!std::filesystem::is_directory(folder, error)) {
    throw InputError({path, 0, 0}, "the folder '" + folder.string() + "' is not there", "an output file in a folder that exists");
  }
  if (std::filesystem::is_directory(target, error)) throw InputError({path, 0, 0}, "is a folder", "an output file");
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), partial_path_(path_) {
  check_output_path(path_);
  if (!is_written_directly(path_)) partial_path_ += ".partial";
  descriptor_ = is_standard_output(path_) ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                          : ::open(partial_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
  buffer_.reserve(2 * kBufferBytes);
}

OutputFile::~OutputFile() {
  try {
    flush();
  } catch (const OutputError&) {
  }
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!is_started_ && partial_path_ != path_) std::remove(partial_path_.c_str());
}

void OutputFile::append(std::string_view record) {
  is_started_ = true;
  buffer_.append(record);
  if (buffer_.size() >= kBufferBytes) flush();
}

void OutputFile::flush() {
  if (descriptor_ < 0) return;
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = count < 0 ? errno : ENOSPC;
      // Part of a record may have gone out: cut the file back to the last complete one.
      const std::size_t end_of_record = done == 0 ? 0 : buffer_.rfind('\n', done - 1) + 1;  // npos + 1 is 0
      const bool is_cut = !is_standard_output(path_) && ::ftruncate(descriptor_, written_ + static_cast<long>(end_of_record)) == 0;
      static_cast<void>(is_cut);  // a pipe or a device has nothing to cut
      buffer_.clear();
      fail(error);
    }
    done += static_cast<std::size_t>(count);
  }
  written_ += static_cast<long>(done);
  buffer_.clear();
}

void OutputFile::finish() {
  flush();
  if (descriptor_ < 0) return;
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(errno);
  if (partial_path_ != path_ && std::rename(partial_path_.c_str(), path_.c_str()) != 0) fail(errno);
}

void OutputFile::fail(int error) {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  throw OutputError((is_standard_output(path_) ? "standard output" : path_) + ": cannot be written: " + std::strerror(error));
}

}  // namespace tenon
