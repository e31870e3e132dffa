// tenon sweep SCENE --samples N: the scene's closed loop in N worlds drawn from its [uncertainty], and what came of them.
//
// World k has the seed given plus k, so that `tenon mpc SCENE --seed S` shows the one that was worst.
#pragma once

#include "tenon/apps/arguments.hpp"
#include "tenon/apps/sweep/crew.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

/// The verb with its flags; `run` as the program has it.
Verb sweep_verb(int (*run)(const Arguments&));

/// What every process of the crew calls, with the same arguments; the first one writes and prints.
int sweep(const Arguments& arguments, Crew& crew, const SolverFactory& make_solver);

}  // namespace tenon
