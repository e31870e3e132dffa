// tenon: reads the command line and runs the verb.
#include "tenon/apps/ampl.hpp"
#include "tenon/apps/command_line.hpp"
#include "tenon/apps/guarded_main.hpp"
#include "tenon/apps/scene_verbs.hpp"
#include "tenon/apps/sweep/mpirun.hpp"

namespace {

int run_verb(int argc, char** argv) {
  if (tenon::is_shared_sweep(argc, argv)) return tenon::run_shared_sweep(argv);
  const auto invocation = tenon::read_command_line(argc, argv);
  if (!invocation) return tenon::kFinished;
  if (invocation->verb->operands == "SCENE") tenon::check_scene_is_for(invocation->verb->name, invocation->arguments.names.front());
  return invocation->verb->run(invocation->arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return tenon::guarded_main([&] { return tenon::is_ampl_call(argc, argv) ? tenon::run_ampl(argc, argv) : run_verb(argc, argv); });
}
