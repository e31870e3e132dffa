// Plain tracking, to compare with: to the nominal plane on a path of least jerk, stiffly, and from its end on the wanted force pushed for.
//
//     r(t) = z_0 + (z_p - z_0)(10 s^3 - 15 s^4 + 6 s^5),  s = t/T;      w = r'' + 2 p (r' - v) + p^2 (r - z)  (+ F/m from T on)
#pragma once

#include "tenon/core/controller.hpp"

namespace tenon::touch_down {

class TrackingLaw final : public Controller {
 public:
  struct Settings {
    double start = 0.36, plane = 0.42;  // m
    double time = 1;                    // s: T
    double pole = 20;                   // 1/s
    double mass = 0.6, force = 5;
    double largest_input = 15;  // m/s^2
    double period = 0.01;
  };
  explicit TrackingLaw(const Settings& settings) : settings_(settings) {}

  int num_measurements() const override { return 5; }
  int num_commands() const override { return 1; }
  double period() const override { return settings_.period; }
  void reset() override {}
  void update(double t, ConstVectorRef measurements, VectorRef commands) override;

 private:
  Settings settings_;
};

}  // namespace tenon::touch_down
