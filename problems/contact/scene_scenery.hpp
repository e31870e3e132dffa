// The picture of a scene for its record: every body with its shapes, rods, ropes and springs between them, and the forces of contacts with faces.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/contact/shapes.hpp"

namespace tenon::contact {

/// Bound to the columns that ContactDae writes: x1,y1,theta1,... (x1,y1,z1,qw1,... in space) and lambda_<contact>. Where the bodies set out
/// so fast that in `duration` s they leave the scene far behind, the heaviest one stays in the middle.
template <int D>
Scenery scenery_of(const Scene<D>& scene, const std::vector<Shape<D>>& shapes, double duration);

extern template Scenery scenery_of<2>(const Scene<2>&, const std::vector<Shape<2>>&, double);
extern template Scenery scenery_of<3>(const Scene<3>&, const std::vector<Shape<3>>&, double);

}  // namespace tenon::contact
