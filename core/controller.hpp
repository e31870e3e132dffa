// A sampled controller, for those who hold it without knowing which it is: measurements in, commands out, once a period.
#pragma once

#include <string>

#include "tenon/core/eigen.hpp"

namespace tenon {

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

  /// Of the record: what the controller believes and how it came to its commands.
  virtual int num_outputs() const { return 0; }
  virtual std::string output_name(int i) const { return "controller" + std::to_string(i + 1); }
  virtual void outputs(VectorRef values) const { static_cast<void>(values); }
};

}  // namespace tenon
