// A flow: the smooth part of an integrator, between two events. HybridIntegrator is the other part.
#pragma once

#include "tenon/core/consistent_start.hpp"
#include "tenon/core/integrator.hpp"

namespace tenon {

class Flow {
 public:
  enum class Step { taken, collapsed, failed };  // failed: F cannot be solved on the way

  virtual ~Flow() = default;

  /// From a consistent state on.
  virtual bool restart(const DaeState& state) = 0;
  /// One step, at most h_max long and not beyond t_limit, which is after end().
  virtual Step step(double t_limit, double h_max) = 0;

  /// The last step's ends.
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// t and x at a time within the last step.
  virtual bool interpolate_state(double t, DaeState& state) = 0;
  /// And xdot and y. False where F cannot be solved there.
  virtual bool interpolate(double t, DaeState& state) = 0;
  /// The same, as accurate as a step's end is: where an event is, the next mode starts.
  virtual bool land(double t, DaeState& state) { return interpolate(t, state); }

  long steps() const { return steps_; }
  long rejected() const { return rejected_; }
  long evaluations() const { return evaluations_; }

 protected:
  double begin_ = 0, end_ = 0;
  long steps_ = 0, rejected_ = 0, evaluations_ = 0;
};

}  // namespace tenon
