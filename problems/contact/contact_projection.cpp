// Back to the manifold of the joints of index 2.
#include <algorithm>
#include <cmath>

#include "tenon/problems/contact/contact_dae.hpp"

namespace tenon::contact {

namespace {

constexpr int kMostProjections = 10;    // Newton's steps back to the joints of index 2
constexpr double kClosedJoint = 1e-12;  // m or rad: one more step squares it away

}  // namespace

/// Newton's method on h = 0 and h' = 0 of the joints of index 2, each step the shortest in the metric of M:  dq = E M^-1 H' mu with
/// H M^-1 H' mu = -h,  likewise dv from -h'. What else is active stays where it is.   (20)
template <int D>
bool ContactDae<D>::project(const DaeMode& mode, double t, VectorRef x, Workspace& workspace) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  const auto move = [&](auto error, auto apply) {
    double largest = 0;
    for (std::size_t row = 0; row < bodies.active.size(); ++row) {
      const std::size_t i = static_cast<std::size_t>(bodies.active[row]);
      const double e = scene_.constraints[i].is_index_2() ? error(bodies.gaps[i]) : 0;
      bodies.rhs[static_cast<int>(row)] = -e;
      largest = std::max(largest, std::abs(e));
    }
    solve(bodies);
    for (auto& step : bodies.acceleration) step.setZero();
    set_accelerations(bodies);
    for (std::size_t i = 0; i < places_.size(); ++i) apply(places_[i], i);
    return largest;
  };
  for (int k = 0; k < kMostProjections; ++k) {
    load(mode, t, x, bodies);
    factorise(mode, t, bodies);
    const double open =
        move([](const auto& g) { return g.h; },
             [&](Place at, std::size_t i) { x.segment(at.q, at.nq) += along(bodies.q[i], bodies.acceleration[i]).head(at.nq); });
    move([](const auto& g) { return g.hdot; },
         [&](Place at, std::size_t i) { x.segment(at.v, at.nv) += bodies.acceleration[i].head(at.nv); });
    if (!x.allFinite()) return false;
    if (open <= kClosedJoint) return true;
  }
  return false;
}

template bool ContactDae<2>::project(const DaeMode& mode, double t, VectorRef x, Workspace& workspace) const;
template bool ContactDae<3>::project(const DaeMode& mode, double t, VectorRef x, Workspace& workspace) const;

}  // namespace tenon::contact
