// The experiment: the finger follows a path that is fixed beforehand, by its own measured position.
//
//     F = m_f r'' + d (r' - v) + k (r - x),      v from the position's difference, through a low-pass
//
//     r' = 0 until `start`, then speed (1 + depth sin(omega (t - start)))        steady: depth = 0
#pragma once

#include "tenon/core/controller.hpp"
#include "tenon/problems/pushed_block/model.hpp"

namespace tenon::pushed_block {

struct Path {
  bool moves = true;
  double start = 0.3;    // s
  double speed = 0.06;   // m/s
  double depth = 0;      // of the speed's modulation
  double frequency = 2;  // Hz
};

class PushScript final : public Controller {
 public:
  PushScript(const Parameters& parameters, const Path& path) : parameters_(parameters), path_(path) { reset(); }

  int num_measurements() const override { return 1; }
  int num_commands() const override { return 1; }
  double period() const override { return parameters_.period; }
  void reset() override;
  void update(double t, ConstVectorRef measurements, VectorRef commands) override;

 private:
  Parameters parameters_;
  Path path_;
  double last_ = 0, rate_ = 0;  // m, m/s
  bool has_last_ = false;
};

}  // namespace tenon::pushed_block
