// What is left of nl_file.hpp once the bytes are known to be good: the part that needs the AMPL solver library. Where that is absent,
// no_ampl_program.cpp answers instead.
#pragma once

#include "tenon/problems/nl/nl_file.hpp"

namespace tenon {

/// Names for messages and reports; empty lists where no file gives them.
struct NlNames {
  std::string problem;
  std::vector<std::string> variables, constraints;
};

/// Fills problem, start and maximises. `objective` from 1, 0 for none. Throws InputError where the library refuses what the scan let pass,
/// OutputError where no temporary file can be written.
NlFile make_ampl_program(const std::string& bytes, const std::string& path, NlNames names, int objective);

}  // namespace tenon
