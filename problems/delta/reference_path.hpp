// Where the wrist should be, as a function of time.
//
//     hold      r = centre
//     circle    r = centre + radius (cos w t, sin w t, 0),  w = 2 pi frequency
//     knots     a cubic from knot to knot, at rest in the first and the last; between them the slope of its neighbours' chord
#pragma once

#include <vector>

#include "tenon/problems/delta/law.hpp"

namespace tenon::delta {

struct ReferencePath {
  enum class Kind { hold, circle, knots };
  struct Knot {
    double t;          // s
    Vector3 position;  // m
  };

  Kind kind = Kind::hold;
  Vector3 centre{0, 0, 0};  // m
  double radius = 0;        // m
  double frequency = 0;     // Hz
  std::vector<Knot> knots;  // of rising time

  Reference at(double t) const;
};

}  // namespace tenon::delta
