#include "tenon/mpc/shift_plan.hpp"

#include <algorithm>
#include <cassert>

namespace tenon {

namespace {

void copy(VectorRef values, IndexRange from, IndexRange to) {
  const int size = std::min(from.size(), to.size());
  values.segment(to.begin, size) = values.segment(from.begin, size);
}

}  // namespace

void shift_plan(const Stages& stages, Point& plan) {
  for (std::size_t k = 0; k + 1 < stages.stages.size(); ++k) {
    const Stages::Stage &stage = stages.stages[k], &next = stages.stages[k + 1];
    assert(stage.variables.size() >= next.variables.size());
    copy(plan.x, next.variables, stage.variables);
    copy(plan.z, next.variables, stage.variables);
    copy(plan.lambda, next.rows, stage.rows);
  }
}

}  // namespace tenon
