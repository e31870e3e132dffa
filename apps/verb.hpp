// A verb of the command line: `tenon VERB ...`.
//
// To add one: write its function in a .cpp of its own, declare it and give it a line in verbs.cpp. A new flag is a line in
// command_line.cpp.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/arguments.hpp"
#include "tenon/apps/exit_code.hpp"

namespace tenon {

struct Verb {
  std::string name;
  std::string description;
  std::string operands;  // how the words after the verb are called in the help, empty where there are none
  int min_operands = 0;
  int max_operands = 0;            // -1: any number
  std::vector<std::string> flags;  // those of command_line.cpp that apply, without their dashes
  int (*run)(const Arguments&);    // returns an ExitCode
};

const std::vector<Verb>& verbs();

}  // namespace tenon
