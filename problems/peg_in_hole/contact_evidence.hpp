// What a pose of the peg and the force on it say against a place of the hole.
//
//     e = min(0, smallest gap + c)^2 / (2 sigma^2) + least over who pushes { nobody, the left block, the right one, both }
//
// The peg cannot be inside a block. Whoever pushes is near, pushes in a direction that its face and friction allow, and along a line
// through the place of contact. Equations: peg_in_hole.md, section 4.
#pragma once

#include <array>

#include "tenon/problems/peg_in_hole/geometry.hpp"

namespace tenon::peg {

class ContactEvidence {
 public:
  /// For holes side by side at x (mm).
  ContactEvidence(const Geometry& geometry, Eigen::ArrayXf x);

  /// The pose in mm; force and moment in N, the moment divided by the lever.
  void observe(const Vector3d& pose, const Vector3d& force);

  /// Of holes at all x, and z and phi (mm): weight * e is added to `against`. Allocates nothing.
  void add(float z, float phi, float weight, Eigen::Ref<Eigen::ArrayXf> against);

 private:
  /// What one block alone, or it with the other's help, must be excused for; and its smallest gap, in units of sqrt(2) sigma.
  struct Block {
    Eigen::ArrayXf gap, alone, helped;
  };
  struct Distances;
  /// Of the block on the left (side = -1) or on the right (+1).
  Distances distances(float side, float z, float phi) const;
  void evaluate(const Distances& distances, Block& block) const;

  Geometry geometry_;
  Eigen::ArrayXf x_;
  std::array<Block, 2> blocks_;                        // left, right
  float pose_x_ = 0, pose_z_ = 0, cos_ = 1, sin_ = 0;  // of the peg
  float force_x_ = 0, force_z_ = 0, moment_ = 0;       // in units of sqrt(2) sigma_F
};

}  // namespace tenon::peg
