// The real binary, run from a test: its exit code and what it prints.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tenon/tests/scratch_folder.hpp"

namespace tenon {

struct Ended {
  int code = -1;
  std::string out, err;
};

/// Runs `tenon arguments` through the shell, in the test's own folder; `prefix` is what stands before it, such as `mpirun -np 2`.
inline Ended run_tenon(const ScratchFolder& folder, const std::string& arguments, const std::string& prefix = "") {
  const std::string command = "cd '" + folder.path("") + "' && " + prefix + " '" TENON_BINARY "' " + arguments + " > stdout.txt 2> stderr.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), folder.read("stdout.txt"), folder.read("stderr.txt")};
}

/// Whether a text is one line that begins and goes on as given.
inline bool is_one_line(const std::string& text, const std::string& begin) {
  return text.starts_with(begin) && text.find('\n') == text.size() - 1;
}

/// Exit code 2, one line that begins as given, no result, and no file that was not there before.
inline void expect_bad_input(const ScratchFolder& folder, const std::string& arguments, const std::string& line) {
  std::set<std::string> names = folder.names();
  names.insert({"stdout.txt", "stderr.txt"});
  const Ended ended = run_tenon(folder, arguments);
  EXPECT_EQ(ended.code, 2) << arguments;
  EXPECT_TRUE(is_one_line(ended.err, "tenon: " + line)) << arguments << "\n" << ended.err;
  EXPECT_EQ(ended.out, "") << arguments;
  EXPECT_EQ(folder.names(), names) << arguments;
}

}  // namespace tenon
