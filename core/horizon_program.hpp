// A nonlinear program that looks ahead from now, to be solved again and again: what a receding horizon holds.
//
//     observe(t, what is measured, what is estimated)  ->  solve  ->  commands(plan, time since)
//
// Its stages are intervals of equal length; all but the last are laid out alike, so that a plan is shifted by copying stage k+1 to stage k.
// `initial_point` is the plan to start from where there is none: it knows the last observation and nothing else.
#pragma once

#include "tenon/core/nlp.hpp"
#include "tenon/core/point.hpp"

namespace tenon {

class HorizonProgram : public Nlp {
 public:
  virtual int num_measurements() const = 0;
  virtual int num_estimates() const { return 0; }
  virtual int num_commands() const = 0;

  /// s: the length of a stage.
  virtual double interval() const = 0;

  /// What is known at time t (s): the measurements, and an estimator's means. Bounds, references and the initial point of the next solve
  /// follow from it. Allocates nothing.
  virtual void observe(double t, ConstVectorRef measurements, ConstVectorRef estimates) = 0;

  /// Whether what was last observed says that going on from the plan before leads nowhere: the next solve then starts from the initial point.
  virtual bool wants_fresh_start() const { return false; }

  /// What a plan commands `elapsed` s after the observation it was made for; beyond its end, what holds still. Allocates nothing.
  virtual void commands(const Point& plan, double elapsed, VectorRef commands) const = 0;

  virtual std::string command_name(int i) const { return "command" + std::to_string(i + 1); }

  /// Of the record: what a plan foresees, in a few numbers (its states at some instants). `plan_outputs` allocates nothing.
  virtual int num_plan_outputs() const { return 0; }
  virtual std::string plan_output_name(int i) const { return "plan" + std::to_string(i + 1); }
  virtual void plan_outputs(const Point& plan, VectorRef values) const { static_cast<void>(plan), static_cast<void>(values); }

  /// A plan as a trajectory, in SI units and under the names of the plant's record: columns, and their values where stage k begins. The last
  /// stage is the end; what is decided for intervals is there that of the last one.
  virtual std::vector<std::string> trajectory_columns() const { return {}; }
  virtual void trajectory(const Point& plan, int k, VectorRef values) const {
    static_cast<void>(plan), static_cast<void>(k), static_cast<void>(values);
  }
};

}  // namespace tenon
