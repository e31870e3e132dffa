// tenon PATH -AMPL [key=value ...]: tenon as a solver that AMPL, Pyomo or JuMP calls.
#pragma once

namespace tenon {

/// Whether the command line is a call of that kind: the word -AMPL stands on it.
bool is_ampl_call(int argc, char** argv);

/// Reads PATH.nl, writes PATH.sol; PATH is a stem or ends with .nl. Options stand on the command line and, before these, in the environment
/// variable `tenon_options`. Returns an ExitCode: 0 whenever the .sol file was written, whatever became of the solve.
int run_ampl(int argc, char** argv);

}  // namespace tenon
