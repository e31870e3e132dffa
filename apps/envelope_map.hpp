// The envelope of a vehicle over a grid of directions, whole or with one rotor failed, and the extremes of its quantities.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "tenon/problems/envelope/envelope.hpp"
#include "tenon/problems/envelope/sphere.hpp"

namespace tenon {

struct EnvelopeQuantity {
  const char* name;  // of its column
  double EnvelopePoint::*value;
};
inline constexpr std::array<EnvelopeQuantity, 5> kEnvelopeQuantities{{{"X1", &EnvelopePoint::X1},
                                                                      {"X2", &EnvelopePoint::X2},
                                                                      {"force", &EnvelopePoint::force},
                                                                      {"torque", &EnvelopePoint::torque},
                                                                      {"torque_hover", &EnvelopePoint::torque_hover}}};

/// Over all directions in which the quantity is defined; none where it is in no direction of the grid.
struct EnvelopeRange {
  bool exists = false;
  SphereExtreme least{}, most{};
};

struct EnvelopeMap {
  int failed = -1;  // the rotor, from 0; -1 for none
  std::vector<EnvelopePoint> points;  // of each direction of the grid
  std::array<EnvelopeRange, kEnvelopeQuantities.size()> ranges;
  double hover_share = 0;  // of the grid's directions
  bool is_convex = true;
  long failures = 0;
  std::vector<std::string> unreachable;

  /// "healthy", or "rotor 3 failed".
  std::string title() const { return failed < 0 ? "healthy" : "rotor " + std::to_string(failed + 1) + " failed"; }
  /// What its columns end with: nothing, or "_failed3".
  std::string suffix() const { return failed < 0 ? "" : "_failed" + std::to_string(failed + 1); }
  double force_gap() const;
  double torque_gap() const;
};

/// Every point of the grid, calling `step` before each, which ends the work by returning false; the extremes are then sought between the
/// points, where the set is convex, from the best of them.
EnvelopeMap map_envelope(const Vehicle& vehicle, int failed, const Envelope::SolverFactory& make_solver,
                         const std::vector<Eigen::Vector3d>& grid, const std::function<bool()>& step);

}  // namespace tenon
