#include "tenon/apps/sweep/mpirun.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace tenon {

namespace {

/// As Open MPI, or MPICH and its relatives, tell it to those they start; 1 where nobody does.
int processes() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* value = std::getenv(name)) return std::atoi(value);
  }
  return 1;
}

}  // namespace

bool is_shared_sweep(int argc, char** argv) {
  return argc > 1 && std::string(argv[1]) == "sweep" && processes() > 1;
}

int run_shared_sweep(char** argv) {
  const std::string program = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "tenon-sweep").string();
  ::execv(program.c_str(), argv);
  throw std::invalid_argument("sweep under mpirun: " + program + " is not there (expected a tenon built where MPI is installed)");
}

}  // namespace tenon
