// What needs no optimiser: straight down on a spring, the same giving way to forces, and a script that tilts the peg, hooks a corner into the
// hole, and uprights it.
//
// They see and command what the receding horizon does, in the same plant. Description: peg_in_hole.md, section 5.
#pragma once

#include "tenon/core/controller.hpp"
#include "tenon/problems/peg_in_hole/geometry.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"

namespace tenon::peg {

/// A controller that moves a reference from where the peg starts.
class ReferenceController : public Controller {
 public:
  /// `start` and `depth` (below the nominal mouth) in mm, the period in s.
  ReferenceController(const Geometry& geometry, const Impedance& impedance, const Vector3d& start, double depth, double period);

  int num_measurements() const override;
  int num_commands() const override;
  double period() const override { return period_; }
  void reset() override;
  void update(double t, ConstVectorRef measurements, VectorRef commands) override;

 protected:
  /// mm/s of (x, z, phi) for the coming period; `reference` and the measured `pose` in mm, the measured `force` in N.
  virtual Vector3d rate(const Vector3d& reference, const Vector3d& pose, const Vector3d& force) = 0;

  Geometry geometry_;
  Impedance impedance_;
  double depth_;

 private:
  Vector3d start_, reference_;
  double period_;
};

/// Down at 20 mm/s, the reference receding from the measured depth.
class StraightDown : public ReferenceController {
 public:
  using ReferenceController::ReferenceController;

 protected:
  Vector3d rate(const Vector3d& reference, const Vector3d& pose, const Vector3d& force) override;
};

/// The same, giving way to lateral forces and moments by 20 mm/s for each N. At 50 Hz that is unstable: a period of some ms.
class Admittance final : public StraightDown {
 public:
  using StraightDown::StraightDown;

 private:
  Vector3d rate(const Vector3d& reference, const Vector3d& pose, const Vector3d& force) override;
};

/// Tilted by 10 degrees, the left corner over the hole whatever the offset; down until something pushes; aside until the corner is at the
/// wall; upright about that corner; down, giving way to lateral forces and moments.
class TiltAndSlide final : public ReferenceController {
 public:
  using ReferenceController::ReferenceController;
  void reset() override;

 private:
  enum class Phase { lower, slide, upright, insert };
  Vector3d rate(const Vector3d& reference, const Vector3d& pose, const Vector3d& force) override;

  Phase phase_ = Phase::lower;
};

}  // namespace tenon::peg
