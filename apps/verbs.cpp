#include "tenon/apps/sweep/run_sweep.hpp"
#include "tenon/apps/verb.hpp"

namespace tenon {

int run_allocate(const Arguments&);
int run_bench(const Arguments&);
int run_check(const Arguments&);
int run_compare(const Arguments&);
int run_envelope(const Arguments&);
int run_estimate(const Arguments&);
int run_fit(const Arguments&);
int run_fly(const Arguments&);
int run_list(const Arguments&);
int run_mpc(const Arguments&);
int run_plan(const Arguments&);
int run_report(const Arguments&);
int run_robot(const Arguments&);
int run_simulate(const Arguments&);
int run_solve(const Arguments&);
int run_sweep(const Arguments&);

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> table{
      {"list", "what tenon knows by name", "[problems|vehicles|missions|scenes|robots|solvers]", 0, 1, {"json"}, &run_list},
      {"allocate",
       "a wrench log becomes throttles and arm angles, row by row",
       "VEHICLE",
       1,
       1,
       {"wrenches", "output", "report", "solver", "set", "cold", "initial", "tolerance", "max-iterations", "time-limit", "trace", "json", "quiet",
        "verbose"},
       &run_allocate},
      {"robot",
       "kinematics and statics of a delta robot at a pose, or its workspace",
       "ROBOT",
       1,
       1,
       {"inverse", "forward", "jacobians", "workspace", "impedance", "set", "json", "quiet"},
       &run_robot},
      {"fly",
       "a mission in closed loop: pose controller, allocation, actuators, rigid body",
       "MISSION",
       1,
       1,
       {"output", "events", "report", "solver", "set", "seed", "json", "quiet", "real-time"},
       &run_fly},
      {"fit", "thrust and torque polynomials from calibration data", "BENCH.csv", 1, 1, {"degree", "constant", "json"}, &run_fit},
      {"envelope",
       "hover efficiency, largest force and torque in all directions, and with each rotor failed",
       "VEHICLE",
       1,
       1,
       {"rows", "output", "report", "solver", "set", "json", "quiet"},
       &run_envelope},
      {"simulate",
       "a scene in time: bodies, contacts, events, energy",
       "SCENE",
       1,
       1,
       {"output", "events", "report", "fast-phase", "solver", "set", "tolerance", "json", "quiet", "real-time"},
       &run_simulate},
      {"plan",
       "one trajectory of a scene by direct collocation",
       "SCENE",
       1,
       1,
       {"output", "report", "trace", "solver", "set", "tolerance", "max-iterations", "time-limit", "json", "quiet", "verbose"},
       &run_plan},
      {"mpc",
       "a receding horizon against its simulated world",
       "SCENE",
       1,
       1,
       {"output", "report", "solver", "set", "seed", "tolerance", "max-iterations", "time-limit", "json", "quiet", "real-time"},
       &run_mpc},
      {"estimate",
       "a scene's hidden state and parameters, from a record",
       "SCENE",
       1,
       1,
       {"measurements", "output", "report", "solver", "set", "json", "quiet"},
       &run_estimate},
      sweep_verb(&run_sweep),
      {"solve",
       "one nonlinear program",
       "PROBLEM",
       1,
       1,
       {"solver", "tolerance", "max-iterations", "time-limit", "starts", "seed", "trace", "dump", "report", "json", "quiet", "verbose"},
       &run_solve},
      {"compare",
       "the same problem on every back end, judged by one ruler",
       "PROBLEM... or --profile DIR",
       0,
       -1,
       {"solvers", "set", "rows", "seed", "tolerance", "max-iterations", "time-limit", "profile", "output", "report", "json", "quiet"},
       &run_compare},
      {"check", "derivatives against differences, pattern, bounds, start", "PROBLEM", 1, 1, {"seed", "tolerance", "json"}, &run_check},
      {"report", "the report page again, from record files alone", "FILE.csv...", 1, -1, {"output", "report", "quiet"}, &run_report},
      {"bench", "benchmark rows: median, p99, machine, versions", "[NAME]", 0, 1, {"json", "quiet"}, &run_bench},
  };
  return table;
}

}  // namespace tenon
