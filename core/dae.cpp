#include "tenon/core/dae.hpp"

#include <limits>

namespace tenon {

double Dae::next_event_time(const DaeState&) const {
  return std::numeric_limits<double>::infinity();
}

double Dae::max_step(const DaeState&, Workspace&) const {
  return std::numeric_limits<double>::infinity();
}

DaeState initial_state_of(const Dae& dae) {
  DaeState state;
  state.x.setZero(dae.num_states());
  state.xdot.setZero(dae.num_states());
  state.y.setZero(dae.num_algebraics());
  state.u.setZero(dae.num_inputs());
  dae.initial_state(state);
  return state;
}

}  // namespace tenon
