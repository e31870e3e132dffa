// tenon plan TASK: the horizon of a task (problems/tasks.hpp) as it looks ahead from the start, to convergence.
#pragma once

#include <string>

#include "tenon/apps/arguments.hpp"

namespace tenon {

/// A row for each stage: its time, then its variables, in the program's own units.
int plan_task(const Arguments& arguments);

}  // namespace tenon
