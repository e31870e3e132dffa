#include "tenon/mpc/mesh_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tenon/mpc/radau_step.hpp"

namespace tenon {

namespace {

constexpr int kMostParts = 5;
constexpr double kSafety = 0.5;  // what is aimed at, of the tolerance

/// A step over interval k of the plan, from this state; the plan itself is the guess.
bool step_over(RadauStep& step, const Plan& plan, std::size_t k, const Vector& from) {
  const PlanInterval& interval = plan.intervals()[k];
  const Vector& abscissae = step.method().abscissae;
  const Vector offset = from - interval.x.col(0);
  for (int i = 0; i < abscissae.size(); ++i) {
    const DaeState at = plan.at(k, abscissae[i]);
    step.x.col(i) = at.x + offset;
    if (i > 0) step.y.col(i - 1) = at.y;
  }
  return step.advance(plan.modes()[static_cast<std::size_t>(interval.phase)], interval.t, interval.length, interval.u);
}

}  // namespace

MeshError mesh_error(const Ocp& ocp, const Plan& plan, int points) {
  MeshError out;
  out.steps.resize(ocp.phases.size());
  RadauStep step(*ocp.dae, points + 1);
  const Eigen::Index s = points;
  Vector x = plan.intervals().front().x.col(0);  // open loop
  bool holds = true;
  for (std::size_t k = 0; k < plan.intervals().size(); ++k) {
    const PlanInterval& interval = plan.intervals()[k];
    double error = std::numeric_limits<double>::infinity();
    if (step_over(step, plan, k, interval.x.col(0))) {
      const auto end = interval.x.col(s);
      error = ((step.x.rightCols(1) - end).cwiseAbs().array() / (1 + end.cwiseAbs().array())).maxCoeff();
    }
    out.steps[static_cast<std::size_t>(interval.phase)].push_back(error);
    out.worst = std::max(out.worst, error);
    holds = holds && step_over(step, plan, k, x);
    x = step.x.rightCols(1);
    const SmoothFunction* const link = ocp.phases[static_cast<std::size_t>(interval.phase)].link.get();
    const bool leaves_phase = k + 1 < plan.intervals().size() && plan.intervals()[k + 1].phase != interval.phase;
    if (leaves_phase && link != nullptr) link->values(Vector(x), x);
  }
  out.end = (x - plan.intervals().back().x.col(s)).cwiseAbs();
  if (!holds) out.end.setConstant(std::numeric_limits<double>::infinity());
  return out;
}

// The error of a step falls as h^(2 s): parts = (e / tolerance)^(1/(2 s))                                                    (12)
Mesh refined(const Mesh& mesh, const MeshError& error, int points, double tolerance) {
  Mesh out;
  for (std::size_t p = 0; p < mesh.size(); ++p) {
    std::vector<double>& borders = out.emplace_back(1, 0.0);
    for (std::size_t k = 0; k + 1 < mesh[p].size(); ++k) {
      const double ratio = error.steps[p][k] / (kSafety * tolerance);
      const double asked = error.steps[p][k] <= tolerance ? 1
                           : std::isfinite(ratio)         ? std::ceil(std::pow(ratio, 0.5 / points))
                                                          : kMostParts;
      const int parts = static_cast<int>(std::clamp(asked, 1.0, static_cast<double>(kMostParts)));
      const double begin = mesh[p][k], width = mesh[p][k + 1] - begin;
      for (int i = 1; i < parts; ++i) borders.push_back(begin + width * i / parts);
      borders.push_back(mesh[p][k + 1]);
    }
  }
  return out;
}

}  // namespace tenon
