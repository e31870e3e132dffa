// The stages of an optimal control problem, in time order: which variables and rows belong to which.
//
//     stage 0        stage 1              stage N
//     [ w_0 ]        [ w_1 ]      ...     [ w_N ]      globals p
//     c_0(w_0, w_1, p)   c_1(w_1, w_2, p)     c_N(w_N, p)
//
// A row may touch variables of its own stage, of the next one (where dynamics lead) and globals (a free duration, parameters); the Hessian
// couples what one row or one term of the objective may: variables of one stage, of a row's two stages, and globals.
//
// A slack is a variable in one row of its stage alone, with a curvature of its own at most: it costs the linear algebra next to nothing.
#pragma once

#include <vector>

namespace tenon {

struct IndexRange {
  int begin = 0, end = 0;  // begin <= i < end

  int size() const { return end - begin; }
  bool contains(int i) const { return begin <= i && i < end; }
  bool operator==(const IndexRange&) const = default;
};

struct Stages {
  struct Stage {
    IndexRange variables, rows;
    IndexRange slacks = {};  // apart from the other variables
  };

  std::vector<Stage> stages;  // every row, and every variable but the globals, is in exactly one range of exactly one of them
  IndexRange globals;

  bool empty() const { return stages.empty(); }
};

/// The numbers of states and inputs of every stage but the last, which has states alone, of a problem that knows them when it is compiled
/// (`using StageSizes = tenon::StageSizes<4, 1>`): the kernels of the linear algebra are then of that size.
template <int States, int Inputs>
struct StageSizes {
  static constexpr int kStates = States, kInputs = Inputs;
};

}  // namespace tenon
