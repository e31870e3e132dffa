// The evaluations of a contact scene ask nothing of the heap, nor does a transition at which nothing happens.
#include <gtest/gtest.h>

#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

void expect_no_allocation(const std::string& scene, const std::vector<std::string>& overrides, double duration) {
  std::vector<std::string> all = overrides;
  all.push_back("simulation.duration=" + std::to_string(duration));
  const SceneRun run = run_scene(scene, all);
  const Dae& dae = *run.dae;
  Dae::Workspace workspace = dae.make_workspace();
  DaeState state = run.final;
  Vector F(dae.num_states() + dae.num_algebraics()), guards(dae.num_guards()), outputs(dae.num_outputs());
  std::vector<double> values(dae.jacobian_pattern().inner.size());
  const Dae::EventLog log = [](const DaeEvent&) {};
  const auto evaluate = [&] {
    dae.derivatives(state.mode, state.t, state.x, state.u, workspace, state.xdot, state.y);
    dae.residual(state.mode, DaePoint(state), workspace, F);
    dae.jacobian(state.mode, DaePoint(state), 1.0, workspace, values);
    dae.guards(state.mode, DaePoint(state), workspace, guards);
    dae.outputs(state, workspace, outputs);
    dae.max_step(state, workspace);
    dae.project(state.mode, state.t, state.x, workspace);
    return dae.transition(state, {}, workspace, log);
  };
  EXPECT_FALSE(evaluate().changed) << scene << ": this is to be a state in which nothing happens";
  const AllocationCounter counter;
  for (int k = 0; k < 3; ++k) evaluate();
  EXPECT_EQ(counter.count(), 0) << scene;
}

TEST(ContactAllocation, NothingIsAllocatedBetweenEvents) {
  expect_no_allocation("bouncing-ball", {}, 0.46);             // in a collision of one law
  expect_no_allocation("bouncing-ball-restitution", {}, 1.0);  // in flight
  expect_no_allocation("bouncing-ball-restitution", {}, 5.0);  // at rest
  expect_no_allocation("falling-body", {}, 1.5);               // on four contacts
  expect_no_allocation("box-stack", {}, 2.0);                  // on redundant ones
  expect_no_allocation("rocking-block", {}, 0.5);              // with friction
  expect_no_allocation("car", {}, 1.0);                        // joints, springs and dampers
  expect_no_allocation("rope-sway", {}, 0.5);                  // a chain
  expect_no_allocation("rope-sway", {"simulation.stabilisation=gear-gupta-leimkuhler"}, 0.5);
}

}  // namespace
}  // namespace tenon
