// Shapes, and what a pair of them has to keep apart.
//
// A shape is a set of balls (corners are balls of radius 0) and a convex with a radius around it. Two shapes touch where a ball of one
// meets the convex of the other, or two balls meet: corners against faces, ball against ball. In the plane nothing else can touch; in space
// the crossing of two boxes' edges is left out.
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

template <int D>
struct Ball {
  Point<double, D> centre;  // in the body's axes
  double radius;
};

template <int D>
struct Shape {
  std::string name;
  int body = kWorld;
  std::vector<Ball<D>> balls;
  Convex<D> convex;     // no vertices: none
  double rounding = 0;  // m: around the convex
};

/// The gaps between two shapes, as contacts with the law, restitution and friction of `pattern`; numbered where there are several.
template <int D>
std::vector<Constraint<D>> contacts_between(const std::vector<const Shape<D>*>& first, const std::vector<const Shape<D>*>& second,
                                            const Constraint<D>& pattern) {
  std::vector<Constraint<D>> contacts;
  const auto add_balls = [&](const Shape<D>& a, const Shape<D>& b) {
    for (const Ball<D>& ball : a.balls) {
      Constraint<D> c = pattern;
      c.a = a.body, c.b = b.body;
      c.gap.a = ball.centre;
      c.shape = b.convex;
      c.radius_a = ball.radius;
      c.radius = ball.radius + b.rounding;
      contacts.push_back(c);
    }
  };
  for (const Shape<D>* a : first) {
    for (const Shape<D>* b : second) {
      if (a == b || a->body == b->body) continue;
      if (!b->convex.vertices.empty()) add_balls(*a, *b);
      if (!a->convex.vertices.empty()) add_balls(*b, *a);
      if (!a->convex.vertices.empty() || !b->convex.vertices.empty()) continue;
      for (const Ball<D>& on_a : a->balls) {
        for (const Ball<D>& on_b : b->balls) {
          Constraint<D> c = pattern;
          c.a = a->body, c.b = b->body;
          c.gap.kind = GapKind::point_point;
          c.gap.a = on_a.centre, c.gap.b = on_b.centre;
          c.radius_a = on_a.radius;
          c.radius = c.gap.offset = on_a.radius + on_b.radius;
          contacts.push_back(c);
        }
      }
    }
  }
  if (contacts.size() > 1) {
    for (std::size_t k = 0; k < contacts.size(); ++k) contacts[k].name += "_" + std::to_string(k + 1);
  }
  return contacts;
}

}  // namespace tenon::contact
