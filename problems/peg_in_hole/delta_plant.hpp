// A peg in a hole, held by the delta robot: its own dynamics, wrist and inner loop in place of the planar plant's mass and spring.
//
//     tau = tau_u + J_c' [ K (r - z) + D (r' - z') ]  of the arms,   a spring and a damper at each gimbal       (delta.md, sections 7, 10)
//
// The task's plane is the robot's x-z plane, the mouth below the base's middle. The gimbals' axes meet at the peg's tip (a remote centre),
// so that the impedance is the task's there. The loop reads 20-bit encoders once a millisecond, its torques act a tick later, and forces
// are those of a momentum observer. Description: peg_in_hole.md, section 3.
#pragma once

#include "tenon/problems/delta/controller.hpp"
#include "tenon/problems/delta/momentum_observer.hpp"
#include "tenon/problems/delta/plant.hpp"
#include "tenon/problems/peg_in_hole/insertion_plant.hpp"

namespace tenon::peg {

class DeltaPegPlant final : public InsertionPlant {
 public:
  /// `believed` is the robot as its law and its observer know it. Of the world, noises do not count, and masses only for the impedance's
  /// damping. Throws std::invalid_argument as the robot's parts do, and where it has no gimbals or does not reach the peg's start.
  DeltaPegPlant(const World& world, const delta::Robot& robot, const delta::Robot& believed);

  void reset(std::uint64_t seed) override;
  void measure(VectorRef values) override;
  bool finished() const override { return lost_ || InsertionPlant::finished(); }
  int num_outputs() const override;
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;

 private:
  struct Torques {
    delta::Vector3 arms{0, 0, 0}, gimbals{0, 0, 0};  // N m
  };

  void step() override;
  /// The inner loop's tick.
  void sample();
  void read_encoders();
  /// The law's gains for the stiffness that is commanded.
  void schedule();
  Vector3d damping_of_loop() const;  // N s/mm

  delta::Plant robot_;
  delta::Controller controller_;
  delta::MomentumObserver observer_;
  delta::Measurement reading_;
  Torques acting_, coming_;  // in this tick and in the next
  ReadingRate seen_;
  bool lost_ = false;  // out of the arms' reach: the run is over
};

}  // namespace tenon::peg
