// The world of a peg in a hole: a mass on the impedance loop's spring, stiff contacts, friction, noisy sensors, a hole that lies somewhere.
//
//     M q'' = K (r - q_m) + D (r' - v_m) + sum_i ( n_i f_i + t_i g_i ),     f = max(0, -k h - d h'),  g = -mu f v_t / sqrt(v_t^2 + v_0^2)
//
// Steps of 20 us (semi-implicit Euler); the inner loop sees the encoders' noise once a millisecond. Equations: peg_in_hole.md, section 3.
#pragma once

#include <vector>

#include "tenon/core/plant.hpp"
#include "tenon/core/random.hpp"
#include "tenon/problems/peg_in_hole/geometry.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"

namespace tenon::peg {

/// Where the hole's mouth is, uniformly within half widths of a middle.
struct HolePrior {
  Vector3d middle{0, 0, 0};          // mm: x, z, phi
  Vector3d half_width{1.5, 0, 0.7};  // mm
};

struct World {
  Geometry geometry;
  Vector3d mass{0.8, 0.8, 0.75};       // kg, of peg and robot, as felt at the peg's tip
  double contact_stiffness = 200;      // N/mm
  double contact_damping_ratio = 0.3;  // of one contact and the mass
  double friction = 0.2;
  double friction_speed = 1;           // mm/s, v_0
  double encoder_noise = 0.005;        // mm, sd
  double force_noise = 0.1;            // N, sd
  double largest_spring = 10.5;        // N, in x and z: the inner loop pushes no harder
  double force_filter = 0.005;         // s
  double success_depth = 19.8;         // mm
  Vector3d start{0, 5, 0};             // mm
  HolePrior prior;
};

class PegPlant final : public Plant {
 public:
  explicit PegPlant(const World& world);

  int num_commands() const override;
  int num_measurements() const override;
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) override;
  void measure(VectorRef values) override;
  bool finished() const override { return success_; }
  int num_outputs() const override;
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  int num_verdicts() const override;
  std::string verdict_name(int i) const override;
  std::string severity() const override { return "largest_force"; }
  void verdicts(VectorRef values) const override;
  std::string measurement_name(int i) const override;
  std::string command_name(int i) const override;

 private:
  void sample_encoders();
  void step(const Vector3d& damping);
  void judge();
  double noise();
  double time() const;

  World world_;
  double damping_;  // N s/mm, d of a contact
  Random random_{0};
  bool surprises_ = false;  // seed 0: the hole in the middle, no noise

  long steps_ = 0;
  Vector3d hole_, pose_, rate_;                // mm, mm/s
  Vector3d reference_, reference_rate_, stiffness_;
  Vector3d seen_pose_, seen_rate_, drive_;     // as the inner loop has them; what it pushes with, N
  Vector3d contact_force_, filtered_force_;    // N
  std::array<double, kContacts> gap_{}, pressure_{};

  bool success_ = false;
  long first_touch_ = -1;  // step
  double time_ = 0, first_touch_peak_ = 0, largest_force_ = 0, sustained_force_ = 0;
  double window_sum_ = 0, millisecond_sum_ = 0;
  std::vector<double> window_;
};

}  // namespace tenon::peg
