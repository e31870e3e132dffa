// What a time was measured on.
#pragma once

#include <string>

namespace tenon {

struct Machine {
  std::string cpu;        // model name
  int cores = 0;          // that the system shows
  std::string compiler;   // name and version
  std::string flags;      // instruction set and build type
  std::string libraries;  // with versions
};

Machine this_machine();

}  // namespace tenon
