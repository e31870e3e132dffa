// A sampled controller, for those who hold it without knowing which it is: measurements in, commands out, once a period.
#pragma once

#include <string>

#include "tenon/core/eigen.hpp"
#include "tenon/core/status.hpp"

namespace tenon {

/// Where a step's commands came from.
enum class PlanSource {
  solved,   // a plan that was solved for, to the tolerance; a law without a plan is always solved
  iterate,  // the last accepted iterate of a solve that was cut short, its violation small enough
  shifted,  // the plan before, shifted: this step's was of no use
  initial,  // the plan that a program starts from, where there was none before
};

/// How a step went.
struct StepLog {
  Status status = Status::solved;  // of the solve
  int iterations = 0;
  double violation = 0;            // of the solve's last iterate: rows and bounds, in the program's units
  PlanSource source = PlanSource::solved;
  double elapsed = 0;              // s on the wall: the whole step

  bool fell_back() const { return source == PlanSource::shifted || source == PlanSource::initial; }
};

class Controller {
 public:
  virtual ~Controller() = default;

  virtual int num_measurements() const = 0;
  virtual int num_commands() const = 0;
  virtual double period() const = 0;  // s

  /// As if just built: before every run.
  virtual void reset() = 0;

  /// The commands held from t (s) on. Allocates nothing and does not throw: a controller always has an answer.
  virtual void update(double t, ConstVectorRef measurements, VectorRef commands) = 0;

  /// Of the last update.
  virtual StepLog last_step() const { return {}; }

  /// Of the record: what the controller believes and how it came to its commands.
  virtual int num_outputs() const { return 0; }
  virtual std::string output_name(int i) const { return "controller" + std::to_string(i + 1); }
  virtual void outputs(VectorRef values) const { static_cast<void>(values); }
};

}  // namespace tenon
