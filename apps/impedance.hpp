// The impedance of a robot that holds a part, measured: delta-grasp with a swept sine on the part or on the wrist, the tactile loop off and
// on.
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/delta/tactile_loop.hpp"

namespace tenon {

struct ImpedancePoint {
  double frequency;              // Hz
  double off, on;                // |F/v|, N s/m, from the simulated sweep
  double linear_off, linear_on;  // the same by the linear model
  double wrist_off, wrist_on;    // where the wrist is pushed and its speed counts
};

struct ImpedanceCurve {
  std::vector<ImpedancePoint> points;
  delta::LoopMargins margins;          // of delta-grasp's loop as it stands
  delta::LoopMargins margins_delayed;  // with 2 ms of delay
};

/// With `robot` (a name or a file) in place of the scene's own.
ImpedanceCurve measure_impedance(const std::string& robot, const std::vector<std::string>& overrides);

}  // namespace tenon
