// The planar world of a peg in a hole: a mass on the impedance loop's spring, stiff contacts, friction, noisy sensors.
//
//     M q'' = K (r - q_m) + D (r' - v_m) + sum_i ( n_i f_i + t_i g_i )
//
// Steps of 20 us (semi-implicit Euler); the inner loop sees the encoders' noise once a millisecond. Equations: peg_in_hole.md, section 3.
#pragma once

#include "tenon/problems/peg_in_hole/insertion_plant.hpp"

namespace tenon::peg {

class PegPlant final : public InsertionPlant {
 public:
  explicit PegPlant(const World& world);

  void reset(std::uint64_t seed) override;
  void measure(VectorRef values) override;

 private:
  void step() override;
  void sample();

  ReadingRate seen_;         // as the inner loop has the pose
  Vector3d drive_;           // what it pushes with, N
  Vector3d filtered_force_;  // N
};

}  // namespace tenon::peg
