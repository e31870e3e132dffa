#include "tenon/problems/peg_in_hole/contact_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tenon::peg {

namespace {

constexpr float kGapDeviation = 0.05F;    // mm, sigma
constexpr float kCompression = 0.05F;     // mm, c: what a contact of 200 N/mm gives way to the 10 N that the spring may push with
constexpr float kForceDeviation = 0.3F;   // N, sigma_F: noise and lag of the force
constexpr float kLargestFriction = 0.5F;  // mu
constexpr float kBoth = 1;                // e_2: two blocks at once can explain nearly any force
constexpr float kUnexplained = 4;         // e_o: a force speaks no louder against a place, since it may be an outlier

constexpr float kGapUnit = 1 / (std::numbers::sqrt2_v<float> * kGapDeviation),
                kForceUnit = 1 / (std::numbers::sqrt2_v<float> * kForceDeviation);

float squared(float value) {
  return value * value;
}

/// at + by x
struct Line {
  float at, by;
  float operator()(float x) const { return at + by * x; }
};

/// What friction cannot account for in a push by a face alone, squared; and in one that the other block helps with: the two cones together
/// span all between them, so that only what lies beyond this one, away from the other block, is left. `away`: the push along the face.
struct Cone {
  Cone(float normal, float away)
      : alone(squared(std::max(0.0F, std::abs(away) - kLargestFriction * normal))),
        helped(squared(std::max(0.0F, away - kLargestFriction * normal))) {}
  float alone, helped;
};

}  // namespace

// Each distance is linear in the hole's x. Lengths are in units of sqrt(2) sigma, moments, about a contact's place, of sqrt(2) sigma_F.
struct ContactEvidence::Distances {
  Line wall, chamfer, flat;                                 // of the corner, from the block's faces
  Line lower_side, lower_bottom, upper_side, upper_bottom;  // of the block's vertices, from the peg's faces
  float corner_moment;
  Line lower_moment, upper_moment;
  Cone on_wall, on_chamfer, on_flat, on_side, on_bottom;
};

ContactEvidence::ContactEvidence(const Geometry& geometry, Eigen::ArrayXf x) : geometry_(geometry), x_(std::move(x)) {
  for (Block& block : blocks_) {
    for (Eigen::ArrayXf* array : {&block.gap, &block.alone, &block.helped}) array->setZero(x_.size());
  }
}

void ContactEvidence::observe(const Vector3d& pose, const Vector3d& force) {
  const double theta = pose[2] / geometry_.lever;
  pose_x_ = static_cast<float>(pose[0]), pose_z_ = static_cast<float>(pose[1]);
  cos_ = static_cast<float>(std::cos(theta)), sin_ = static_cast<float>(std::sin(theta));
  const Eigen::Vector3f scaled = kForceUnit * force.cast<float>();
  force_x_ = scaled[0], force_z_ = scaled[1], moment_ = scaled[2];
}

ContactEvidence::Distances ContactEvidence::distances(float s, float z, float phi) const {
  const auto half = static_cast<float>(geometry_.half_opening()), chamfer = static_cast<float>(geometry_.chamfer);
  const float half_width = static_cast<float>(geometry_.width) / 2, lever = static_cast<float>(geometry_.lever);
  const float ch = std::cos(phi / lever), sh = std::sin(phi / lever), c = cos_, sn = sin_;
  constexpr float kDiagonal = 1 / std::numbers::sqrt2_v<float>, u = kGapUnit;

  // the peg's corner in the hole's axes, the block's vertices from the middle of the peg's bottom, where the hole's x is 0
  const float arm_x = s * c * half_width, arm_z = s * sn * half_width;
  const float from_x = pose_x_ + arm_x, from_z = pose_z_ + arm_z - z;
  const float hx = s * (ch * from_x + sh * from_z), hz = ch * from_z - sh * from_x;
  const float low_x = ch * s * half + sh * chamfer - pose_x_, low_z = sh * s * half - ch * chamfer + z - pose_z_;
  const float high_x = ch * s * (half + chamfer) - pose_x_, high_z = sh * s * (half + chamfer) + z - pose_z_;
  const auto side = [&](float x, float at_z) { return Line{u * (s * (c * x + sn * at_z) - half_width), u * s * c}; };
  const auto bottom = [&](float x, float at_z) { return Line{u * (sn * x - c * at_z), u * sn}; };

  // a x F / l, to be taken from the moment
  const auto moment = [&](float x, float at_z) { return moment_ - (x * force_z_ - at_z * force_x_) / lever; };
  const float moment_by_x = -force_z_ / lever;

  // upwards and sideways in the hole's and in the peg's axes; sideways: as the block pushes
  const float up = ch * force_z_ - sh * force_x_, out = -s * (ch * force_x_ + sh * force_z_);
  const float along = c * force_z_ - sn * force_x_, across = -s * (c * force_x_ + sn * force_z_);
  return {.wall = {u * (half - hx), u * s * ch},
          .chamfer = {u * kDiagonal * (half + chamfer - hx + hz), u * kDiagonal * (s * ch + sh)},
          .flat = {u * hz, u * sh},
          .lower_side = side(low_x, low_z),
          .lower_bottom = bottom(low_x, low_z),
          .upper_side = side(high_x, high_z),
          .upper_bottom = bottom(high_x, high_z),
          .corner_moment = moment(arm_x, arm_z),
          .lower_moment = {moment(low_x, low_z), moment_by_x},
          .upper_moment = {moment(high_x, high_z), moment_by_x},
          .on_wall = {out, -up},
          .on_chamfer = {kDiagonal * (up + out), kDiagonal * (out - up)},
          .on_flat = {up, out},
          .on_side = {across, -along},
          .on_bottom = {along, across}};
}

void ContactEvidence::evaluate(const Distances& d, Block& block) const {
  const float* const xs = x_.data();
  float *const gaps = block.gap.data(), *const alone = block.alone.data(), *const helped = block.helped.data();
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const float x = xs[i];
    const float wall = d.wall(x), chamfer = d.chamfer(x), flat = d.flat(x);
    const float lower_side = d.lower_side(x), lower_bottom = d.lower_bottom(x), upper_side = d.upper_side(x),
                upper_bottom = d.upper_bottom(x);
    const float corner = std::max(std::max(wall, chamfer), flat), lower = std::max(lower_side, lower_bottom),
                upper = std::max(upper_side, upper_bottom);
    gaps[i] = std::min(corner, std::min(lower, upper));

    // how far from each contact, and from the face that is to push there
    const float at_corner = squared(std::max(0.0F, corner)), at_lower = squared(std::max(0.0F, lower)),
                at_upper = squared(std::max(0.0F, upper));
    const float at_wall = squared(corner - wall), at_chamfer = squared(corner - chamfer), at_flat = squared(corner - flat);
    const float at_lower_side = squared(lower - lower_side), at_lower_bottom = squared(lower - lower_bottom);
    const float at_upper_side = squared(upper - upper_side), at_upper_bottom = squared(upper - upper_bottom);
    const auto by_faces = [&](float Cone::*excess) {
      return std::array<float, 3>{
          at_corner + std::min(at_wall + d.on_wall.*excess, std::min(at_chamfer + d.on_chamfer.*excess, at_flat + d.on_flat.*excess)),
          at_lower + std::min(at_lower_side + d.on_side.*excess, at_lower_bottom + d.on_bottom.*excess),
          at_upper + std::min(at_upper_side + d.on_side.*excess, at_upper_bottom + d.on_bottom.*excess)};
    };
    const auto single = by_faces(&Cone::alone), shared = by_faces(&Cone::helped);
    alone[i] = std::min(single[0] + squared(d.corner_moment),
                        std::min(single[1] + squared(d.lower_moment(x)), single[2] + squared(d.upper_moment(x))));
    helped[i] = std::min(shared[0], std::min(shared[1], shared[2]));
  }
}

void ContactEvidence::add(float z, float phi, float weight, Eigen::Ref<Eigen::ArrayXf> against) {
  evaluate(distances(-1, z, phi), blocks_[0]);
  evaluate(distances(1, z, phi), blocks_[1]);
  const auto& [left, right] = blocks_;
  const float nobody = squared(force_x_) + squared(force_z_) + squared(moment_);
  against += weight * ((left.gap.min(right.gap) + kGapUnit * kCompression).min(0.0F).square() +
                       left.alone.min(right.alone).min(left.helped + right.helped + kBoth).min(std::min(nobody, kUnexplained)));
}

}  // namespace tenon::peg
