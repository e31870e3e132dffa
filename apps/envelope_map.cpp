#include "tenon/apps/envelope_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tenon {

namespace {

constexpr int kStarts = 2;  // of a search for an extreme, from the best points of the grid

/// The largest of sign times the quantity; no value where the quantity is defined nowhere.
std::optional<SphereExtreme> extreme(Envelope& envelope, double EnvelopePoint::*quantity, double sign, const EnvelopeMap& map,
                                     const std::vector<Eigen::Vector3d>& grid) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    if (!std::isnan(map.points[k].*quantity)) order.push_back(k);
  }
  if (order.empty()) return std::nullopt;
  const auto value = [&](std::size_t k) { return sign * (map.points[k].*quantity); };
  const auto end = order.begin() + std::min<std::ptrdiff_t>(kStarts, std::ssize(order));
  std::partial_sort(order.begin(), end, order.end(), [&](std::size_t a, std::size_t b) { return value(a) > value(b); });
  SphereExtreme best{value(order.front()), grid[order.front()]};
  if (!map.is_convex) return best;
  const double spacing = std::sqrt(4 * std::numbers::pi / static_cast<double>(grid.size()));
  for (auto k = order.begin(); k != end; ++k) {
    const SphereExtreme found =
        climb([&](const Eigen::Vector3d& n) { return sign * (envelope.at(n).*quantity); }, {value(*k), grid[*k]}, spacing);
    if (found.value > best.value) best = found;
  }
  return best;
}

}  // namespace

double EnvelopeMap::force_gap() const {
  return std::transform_reduce(points.begin(), points.end(), 0.0, [](double a, double b) { return std::max(a, b); },
                               [](const EnvelopePoint& point) { return point.force_gap; });
}

double EnvelopeMap::torque_gap() const {
  return std::transform_reduce(points.begin(), points.end(), 0.0, [](double a, double b) { return std::max(a, b); },
                               [](const EnvelopePoint& point) { return point.torque_gap; });
}

EnvelopeMap map_envelope(const Vehicle& vehicle, int failed, const Envelope::SolverFactory& make_solver,
                         const std::vector<Eigen::Vector3d>& grid, const std::function<bool()>& step) {
  Envelope envelope(vehicle, failed, make_solver);
  EnvelopeMap map;
  map.failed = failed;
  map.is_convex = envelope.is_convex();
  map.unreachable = envelope.unreachable();
  long hovers = 0;
  for (const Eigen::Vector3d& direction : grid) {
    if (!step()) return map;
    map.points.push_back(envelope.at(direction));
    if (!std::isnan(map.points.back().X1)) ++hovers;
  }
  map.hover_share = static_cast<double>(hovers) / static_cast<double>(grid.size());
  for (std::size_t q = 0; q < kEnvelopeQuantities.size(); ++q) {
    const auto quantity = kEnvelopeQuantities[q].value;
    const auto least = extreme(envelope, quantity, -1, map, grid), most = extreme(envelope, quantity, 1, map, grid);
    if (least && most) map.ranges[q] = {true, {-least->value, least->direction}, *most};
  }
  map.failures = envelope.failures();
  return map;
}

}  // namespace tenon
