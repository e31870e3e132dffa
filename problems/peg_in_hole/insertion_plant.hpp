// What every plant of the task shares: the hole that is drawn, the contacts with their friction, the commands, the record and the verdicts.
//
//     sum_i ( n_i f_i + t_i g_i ),     f = max(0, -k h - d h'),   g = -mu f v_t / sqrt(v_t^2 + v_0^2)              peg_in_hole.md (3.2)
//
// What moves the peg is the derived plant's affair, in steps of 20 us; its inner loop runs once a millisecond.
#pragma once

#include <deque>
#include <vector>

#include "tenon/core/plant.hpp"
#include "tenon/core/random.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/geometry.hpp"

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
  double friction_speed = 1;     // mm/s, v_0
  double encoder_noise = 0.005;  // mm, sd
  double force_noise = 0.1;      // N, sd
  double largest_spring = 10.5;  // N, in x and z: the inner loop pushes no harder
  double force_filter = 0.005;   // s
  double delay = 0;              // s, by which commands act late
  double success_depth = 19.8;   // mm
  Vector3d start{0, 5, 0};       // mm
  HolePrior prior;
};

class InsertionPlant : public Plant {
 public:
  int num_commands() const final;
  int num_measurements() const final;
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) final;
  bool finished() const override { return success_; }
  int num_outputs() const override;
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  int num_verdicts() const final;
  std::string verdict_name(int i) const final;
  std::string severity() const final { return "largest_force"; }
  void verdicts(VectorRef values) const final;
  std::string measurement_name(int i) const final;
  std::string command_name(int i) const final;

 protected:
  static constexpr double kStep = 2e-5;        // s
  static constexpr long kStepsPerSample = 50;  // of the inner loop
  static constexpr double kPeriod = kStep * kStepsPerSample;

  struct Contacts {
    std::array<double, kContacts> gap{}, pressure{};  // mm, N
    Eigen::Matrix<double, 2, kContacts> pushes = Eigen::Matrix<double, 2, kContacts>::Zero();  // N: on the peg, of each contact with its friction
    Vector3d force{0, 0, 0};                          // on the pose, N
  };

  explicit InsertionPlant(const World& world);

  /// From now to 20 us later; pose_, rate_ and contacts_ are then up to date.
  virtual void step() = 0;

  Contacts contacts(const Vector3d& pose, const Vector3d& rate) const;
  bool is_sample() const { return steps_ % kStepsPerSample == 0; }
  /// Pose, rate, reference and its rate; the force is left to the derived plant.
  void measure_motion(const Vector3d& seen_pose, const Vector3d& seen_rate, VectorRef values) const;
  /// Normal, of variance 1; zero where the seed is.
  double noise();

  World world_;
  Vector3d pose_, rate_;  // mm, mm/s
  Vector3d reference_, reference_rate_, stiffness_;
  Contacts contacts_;

 private:
  struct Pending {
    long step;  // at which they act
    Eigen::Vector<double, kCommands> commands;
  };

  void act(ConstVectorRef commands);
  void judge();
  double time() const;

  double damping_;  // N s/mm, d of a contact
  Random random_{0};
  bool surprises_ = false;  // seed 0: the hole in the middle, no noise
  long steps_ = 0;
  std::deque<Pending> pending_;
  Vector3d hole_;

  bool success_ = false;
  long first_touch_ = -1;  // step
  double time_ = 0, first_touch_peak_ = 0, largest_force_ = 0, sustained_force_ = 0;
  // since the commands last changed: the largest force (N), and who touched
  double tick_peak_ = 0;
  std::array<bool, kContacts> touched_{};
  double window_sum_ = 0, millisecond_sum_ = 0;
  std::vector<double> window_;
};

/// The difference of readings through a first-order low-pass of 2 ms: what an inner loop knows of a rate.
class ReadingRate {
 public:
  void reset(const Vector3d& reading) { reading_ = reading, rate_.setZero(); }
  void update(const Vector3d& reading, double period) {
    constexpr double kTime = 2e-3;
    const Vector3d difference = (reading - reading_) / period;
    rate_ += period / (period + kTime) * (difference - rate_);
    reading_ = reading;
  }
  const Vector3d& reading() const { return reading_; }
  const Vector3d& rate() const { return rate_; }

 private:
  Vector3d reading_{0, 0, 0}, rate_{0, 0, 0};
};

}  // namespace tenon::peg
