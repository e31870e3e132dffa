// What a controller is tried on: a simulated world with its noise and its surprises, for those who hold it without knowing which it is.
//
// All that is random in it is drawn from the seed of `reset`, and nothing else is: a run is repeated bit for bit. Seed 0 draws nothing: the
// world as its scene states it. What the world hides (the truth) is there for records and judges; no controller is given it.
#pragma once

#include <cstdint>
#include <string>

#include "tenon/core/eigen.hpp"

namespace tenon {

class Plant {
 public:
  virtual ~Plant() = default;

  virtual int num_commands() const = 0;
  virtual int num_measurements() const = 0;

  /// A new world, drawn from the seed, at t = 0.
  virtual void reset(std::uint64_t seed) = 0;

  /// From now to t_end (s) under these commands.
  virtual void advance(double t_end, ConstVectorRef commands) = 0;

  /// What the sensors say now. Called once a tick, since noise is drawn here.
  virtual void measure(VectorRef values) = 0;

  /// The run is over: the task is done, or cannot be any more.
  virtual bool finished() const = 0;

  /// Of the record: the truth at this instant, sampled after every tick.
  virtual int num_outputs() const = 0;
  virtual std::string output_name(int i) const = 0;
  virtual void outputs(VectorRef values) const = 0;

  /// Of a sweep, at the end of a run: first what was drawn, then `success` (0 or 1), then what else came of it: times, forces.
  virtual int num_verdicts() const = 0;
  virtual std::string verdict_name(int i) const = 0;
  virtual void verdicts(VectorRef values) const = 0;
  /// The verdict whose greatest value is the worst.
  virtual std::string severity() const { return {}; }

  virtual std::string measurement_name(int i) const { return "measured" + std::to_string(i + 1); }
  virtual std::string command_name(int i) const { return "command" + std::to_string(i + 1); }
};

}  // namespace tenon
