// The dump of a failed solve: all that is needed to fail the same way again, on any back end and any machine.
//
// One JSON object:
//
//     schema        1
//     problem       the name on the command line
//     built_in      the built-in name, or
//     nl, nl_hex    the bytes of the .nl file as text, or in hexadecimal where they are no plain text
//     options       tolerance, max_iterations, time_limit (null: none)
//     start         x, lambda, z: where the solve began, and where a replay begins
//     solver, status, iterations, objective, residual, explanation, infeasible_constraints, point {x, lambda, z}: how it ended, for
//                   the reader alone
//
// `tenon solve FILE.json` and `tenon compare FILE.json` go from `start` with `options`; flags on the command line come first. The problem
// is inside, so that the dump stays true when the file it came from has changed.
#pragma once

#include <string>

#include "tenon/apps/named_problem.hpp"

namespace tenon {

/// Writes FILE. Throws OutputError.
void write_dump(const std::string& path, const NamedProblem& named, const Options& options, const Measurement& measurement);

/// Throws InputError where the file cannot be read, is no JSON, or is no dump.
NamedProblem read_dump(const std::string& path);

}  // namespace tenon
