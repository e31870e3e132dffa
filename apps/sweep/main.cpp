// tenon-sweep: `tenon sweep` in each process of an mpirun. Apart from that it is the same program, without Ipopt (mpirun.hpp).
#include <stdexcept>

#include "tenon/apps/command_line.hpp"
#include "tenon/apps/guarded_main.hpp"
#include "tenon/apps/sweep/mpi_crew.hpp"
#include "tenon/apps/sweep/run_sweep.hpp"
#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"

namespace tenon {

namespace {

MpiCrew* crew = nullptr;

int run(const Arguments& arguments) {
  const std::string own = describe_newton_kkt().name;
  if (arguments.solver.value_or(own) != own) {
    throw std::invalid_argument("sweep under mpirun: no solver '" + *arguments.solver + "' (expected " + own + ")");
  }
  return sweep(arguments, *crew, make_newton_kkt);
}

}  // namespace

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> table{sweep_verb(&run)};
  return table;
}

}  // namespace tenon

int main(int argc, char** argv) {
  tenon::MpiCrew crew;
  tenon::crew = &crew;
  const int code = tenon::guarded_main([&] {
    const auto invocation = tenon::read_command_line(argc, argv);
    return invocation ? invocation->verb->run(invocation->arguments) : tenon::kFinished;
  });
  if (code == tenon::kBadInput || code == tenon::kNoOutput || code == tenon::kNotSolved) crew.abort(code);
  return code;
}
