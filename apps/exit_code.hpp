// How the program ends, for scripts.
#pragma once

namespace tenon {

enum ExitCode : int {
  kFinished = 0,   // solved, or done
  kNotSolved = 1,  // not solved, or a run that cannot go on; the record so far is written
  kBadInput = 2,   // bad usage or bad input; nothing is written
  kNoOutput = 3,   // output that cannot be written
  kInterrupted = 130,
};

}  // namespace tenon
