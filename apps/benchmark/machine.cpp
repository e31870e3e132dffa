#include "tenon/apps/benchmark/machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <thread>

#include "tenon/core/eigen.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = cpu_model();
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
#ifdef __clang__
  machine.compiler = fmt::format("clang {}", __clang_version__);
#else
  machine.compiler = fmt::format("gcc {}", __VERSION__);
#endif
  machine.flags = TENON_BUILD_FLAGS;
  machine.libraries = fmt::format("tenon {}, Eigen {}.{}.{}, fmt {}", TENON_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                  EIGEN_MINOR_VERSION, FMT_VERSION);
  for (const SolverDescription& s : list_solvers()) {
    if (s.available) machine.libraries += fmt::format("; {}: {}", s.name, s.description);
  }
  return machine;
}

}  // namespace tenon
