// In place of ampl_program.cpp where the AMPL solver library was absent at the time of the build, or not wanted.
#include <stdexcept>

#include "tenon/problems/nl/ampl_program.hpp"

namespace tenon {

bool nl_files_are_available() {
  return false;
}

NlFile make_ampl_program(const std::string&, const std::string& path, NlNames, int) {
  throw std::invalid_argument(path + ": .nl files are not available: the AMPL solver library was absent when tenon was built");
}

}  // namespace tenon
