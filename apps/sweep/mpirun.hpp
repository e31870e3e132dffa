// `mpirun -np N tenon sweep ...`: the work is done by tenon-sweep, a program of its own.
//
// Debian's Ipopt brings a sequential MUMPS, whose empty MPI functions would stand before the real ones in a program that has both: every
// process would believe itself alone. So the program that speaks MPI has no Ipopt in it, and `tenon` turns into it.
#pragma once

namespace tenon {

/// Whether this is a sweep in one of several processes that an mpirun started.
bool is_shared_sweep(int argc, char** argv);

/// Turns this process into tenon-sweep, which lies beside tenon or, installed, in the same folder. Throws std::invalid_argument where it is
/// not there.
int run_shared_sweep(char** argv);

}  // namespace tenon
