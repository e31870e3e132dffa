// The formulas of AssemblyProgram at one x: what an interval's objective, rows and derivatives are made of.  peg_in_hole.md, section 2
#include <algorithm>
#include <cmath>
#include <vector>

#include "tenon/problems/peg_in_hole/assembly_program.hpp"

namespace tenon::peg {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

// (2.7), each times the interval; the rate of the reference's rate without it
constexpr double kHeightWeight = 0.02, kLateralWeight = 0.3, kSpringForceWeight = 0.02, kRateWeight = 0.05, kRateChangeWeight = 1e-3,
                 kForceWeight = 1e-3, kForceSlope = 1e-4;

}  // namespace

/// What an interval's formulas share at one x.
struct AssemblyProgram::Interval {
  std::array<Jet, kContacts> gap;         // at the end's pose
  Eigen::Matrix<double, 3, kContacts> g;  // gradients of the gaps
  Matrix3d curvature;                     // W = sum lambda_i hess h_i = d(contact force)/d(pose)
  Vector3d force;                         // F = m (w - v) - g lambda: of spring and damper
  Vector3d spring;                        // r - q at the end
  Vector3d rate;                          // u
};

struct AssemblyProgram::Contacts final : Nlp::Scratch {
  explicit Contacts(int count) : intervals(static_cast<std::size_t>(count)) {}
  std::vector<Interval> intervals;
};

Nlp::Workspace AssemblyProgram::make_workspace() const {
  return std::make_unique<Contacts>(problem_.intervals);
}

void AssemblyProgram::prepare(ConstVectorRef x, Workspace& workspace) const {
  std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  for (int k = 0; k < problem_.intervals; ++k) {
    Interval& at = intervals[static_cast<std::size_t>(k)];
    const double* stage = x.data() + kStage * k;
    const Eigen::Map<const Vector3d> q(stage + kPose), v(stage + kVelocity), e(stage + kSpring), w(stage + kNext);
    const Eigen::Map<const Vector6> lambda(stage + kForces);
    const Vector3d end = q + step_ * w;
    at.gap = smooth_gaps(problem_.geometry, problem_.smoothing, end, hole_);
    at.curvature.setZero();
    for (int i = 0; i < kContacts; ++i) {
      const Jet& gap = at.gap[static_cast<std::size_t>(i)];
      at.g.col(i) = gap.gradient;
      at.curvature += lambda[i] * gap.hessian;
    }
    at.force = inertia_.cwiseProduct(w - v) - at.g * lambda;                      // (2.2)
    at.spring = keep_.cwiseProduct(e) + yield_.cwiseProduct(at.force);            // (2.3)
    at.rate = (at.spring - e) / step_ + w;                                        // (2.4)
  }
}

double AssemblyProgram::objective(ConstVectorRef x, Workspace& workspace) const {
  const std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  const double dt = problem_.interval;
  double sum = 0;
  for (int k = 0; k < problem_.intervals; ++k) {
    const Interval& at = intervals[static_cast<std::size_t>(k)];
    const double *stage = x.data() + kStage * k, *next = stage + kStage;
    const Eigen::Map<const Vector6> lambda(stage + kForces);
    const Eigen::Map<const Vector3d> u(stage + kRate), u_next(next + kRate);
    const double height = next[1] - wanted_height(k + 1), x_error = next[0] - lateral_[0], phi_error = next[2] - lateral_[2];
    sum += dt * (kHeightWeight * height * height + kLateralWeight * (x_error * x_error + phi_error * phi_error) +
                 kSpringForceWeight * at.force.squaredNorm() + kRateWeight * u_next.squaredNorm() + kForceWeight * lambda.squaredNorm() +
                 kForceSlope * lambda.sum()) +
           kRateChangeWeight * (at.rate - u).squaredNorm();
  }
  return sum;
}

// With p = g lambda:   dF = m (dw - dv) - dp,   d(u+ - u) = (a-1)/c de + (1 + b m/c) dw - b m/c dv - du - b/c dp,   dp = W (dq + c dw) + g dlambda
void AssemblyProgram::gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const {
  const std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  const double dt = problem_.interval;
  gradient.setZero();
  for (int k = 0; k < problem_.intervals; ++k) {
    const Interval& at = intervals[static_cast<std::size_t>(k)];
    const double *stage = x.data() + kStage * k, *next = stage + kStage;
    double *out = gradient.data() + kStage * k, *out_next = out + kStage;
    const Eigen::Map<const Vector6> lambda(stage + kForces);
    const Eigen::Map<const Vector3d> u(stage + kRate), u_next(next + kRate);
    const Vector3d by_force = 2 * dt * kSpringForceWeight * at.force, by_change = 2 * kRateChangeWeight * (at.rate - u);
    const Vector3d through_force = inertia_.cwiseProduct(by_force + yield_.cwiseProduct(by_change) / step_);
    const Vector3d by_contact = -by_force - yield_.cwiseProduct(by_change) / step_;
    const Vector3d by_pose = at.curvature * by_contact;

    Eigen::Map<Vector3d>(out + kPose) += by_pose;
    Eigen::Map<Vector3d>(out + kVelocity) -= through_force;
    Eigen::Map<Vector3d>(out + kSpring) += ((keep_.array() - 1) / step_ * by_change.array()).matrix();
    Eigen::Map<Vector3d>(out + kRate) -= by_change;
    Eigen::Map<Vector3d>(out + kNext) = through_force + by_change + step_ * by_pose;
    Eigen::Map<Vector6>(out + kForces) =
        at.g.transpose() * by_contact + dt * (2 * kForceWeight * lambda + Vector6::Constant(kForceSlope));

    out_next[0] += 2 * dt * kLateralWeight * (next[0] - lateral_[0]);
    out_next[1] += 2 * dt * kHeightWeight * (next[1] - wanted_height(k + 1));
    out_next[2] += 2 * dt * kLateralWeight * (next[2] - lateral_[2]);
    Eigen::Map<Vector3d>(out_next + kRate) += 2 * dt * kRateWeight * u_next;
  }
}

void AssemblyProgram::constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const {
  const std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  for (int k = 0; k < problem_.intervals; ++k) {
    const Interval& at = intervals[static_cast<std::size_t>(k)];
    const double* stage = x.data() + kStage * k;
    const Eigen::Map<const Vector3d> q(stage + kPose), w(stage + kNext);
    double* row = values.data() + kRows * k;
    Eigen::Map<Vector3d>(row + kPose) = q + step_ * w;
    Eigen::Map<Vector3d>(row + kVelocity) = w;
    Eigen::Map<Vector3d>(row + kSpring) = at.spring;
    Eigen::Map<Vector3d>(row + kRate) = at.rate;
    for (int r = 0; r < kStates; ++r) row[r] -= stage[kStage + r];
    for (int i = 0; i < kContacts; ++i) {
      row[kGaps + i] = at.gap[static_cast<std::size_t>(i)].value;
      row[kProducts + i] = stage[kForces + i] * row[kGaps + i];
    }
  }
}

void AssemblyProgram::jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const {
  const std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  double* out = values.data();
  for (int k = 0; k < problem_.intervals; ++k) {
    const Interval& at = intervals[static_cast<std::size_t>(k)];
    const double* lambda = x.data() + kStage * k + kForces;
    const auto before = [&] {
      if (k > 0) *out++ = -1;
    };
    const auto gaps = [&](int axis, double times) {
      for (int i = 0; i < kContacts; ++i) *out++ = times * at.g(axis, i);
      for (int i = 0; i < kContacts; ++i) *out++ = times * lambda[i] * at.g(axis, i);
    };
    for (int j = 0; j < 3; ++j) {
      before(), *out++ = 1;
      for (int i = 0; i < 3; ++i) *out++ = -yield_[i] * at.curvature(i, j);
      for (int i = 0; i < 3; ++i) *out++ = -yield_[i] / step_ * at.curvature(i, j);
      gaps(j, 1);
    }
    for (int j = 0; j < 3; ++j) before(), *out++ = -yield_[j] * inertia_[j], *out++ = -yield_[j] * inertia_[j] / step_;
    for (int j = 0; j < 3; ++j) before(), *out++ = keep_[j], *out++ = (keep_[j] - 1) / step_;
    for (int j = 0; j < 3; ++j) before();
    for (int j = 0; j < 3; ++j) {
      *out++ = step_, *out++ = 1;
      for (int i = 0; i < 3; ++i) *out++ = yield_[i] * ((i == j ? inertia_[i] : 0) - step_ * at.curvature(i, j));
      for (int i = 0; i < 3; ++i) *out++ = yield_[i] * ((i == j ? inertia_[i] / step_ : 0) - at.curvature(i, j)) + (i == j ? 1 : 0);
      gaps(j, step_);
    }
    for (int i = 0; i < kContacts; ++i) {
      for (int r = 0; r < 3; ++r) *out++ = -yield_[r] * at.g(r, i);
      for (int r = 0; r < 3; ++r) *out++ = -yield_[r] / step_ * at.g(r, i);
      *out++ = at.gap[static_cast<std::size_t>(i)].value;
    }
  }
  std::fill_n(out, kStates, -1.0);
}

// Squares of F and u+ - u by their rows (above), the curvature of p = g lambda along y, what of f and the dynamics depends on p, and that of
// gaps and products:                                                                                                    (2.9)
void AssemblyProgram::hessian(ConstVectorRef x, double sigma, ConstVectorRef multipliers, Workspace& workspace,
                              std::span<double> values) const {
  const std::vector<Interval>& intervals = static_cast<Contacts&>(*workspace).intervals;
  const double dt = problem_.interval;
  Eigen::Matrix<double, kStage, kStage> h;
  Eigen::Matrix<double, kStage, 6> rows;  // of dF, then of d(u+ - u), transposed
  double* out = values.data();
  const auto on_state = [&](int k, int i) {  // the squares of a state; nothing depends on the first one
    if (k == 0) return 0.0;
    if (i >= kRate) return 2 * sigma * dt * kRateWeight;
    return i < kVelocity ? 2 * sigma * dt * (i == 1 ? kHeightWeight : kLateralWeight) : 0.0;
  };
  for (int k = 0; k < problem_.intervals; ++k) {
    const Interval& at = intervals[static_cast<std::size_t>(k)];
    const double* lambda = x.data() + kStage * k + kForces;
    const double* by_row = multipliers.data() + kRows * k;
    const Eigen::Map<const Vector3d> by_spring(by_row + kSpring), by_rate(by_row + kRate);
    const Vector3d change = at.rate - x.segment<3>(kStage * k + kRate);
    const Vector3d y = -2 * sigma * dt * kSpringForceWeight * at.force -
                       yield_.cwiseProduct(by_spring + (by_rate + 2 * sigma * kRateChangeWeight * change) / step_);

    rows.setZero();
    for (int j = 0; j < 3; ++j) {
      const double through = yield_[j] / step_;
      auto of_force = rows.col(j), of_change = rows.col(3 + j);
      of_force.segment<3>(kPose) = -at.curvature.row(j);
      of_force.segment<3>(kNext) = -step_ * at.curvature.row(j);
      of_force.segment<kContacts>(kForces) = -at.g.row(j);
      of_force[kVelocity + j] = -inertia_[j];
      of_force[kNext + j] += inertia_[j];
      of_change = through * of_force;
      of_change[kSpring + j] = (keep_[j] - 1) / step_;
      of_change[kRate + j] = -1;
      of_change[kNext + j] += 1;
      of_force *= std::sqrt(2 * std::abs(sigma) * dt * kSpringForceWeight);
      of_change *= std::sqrt(2 * std::abs(sigma) * kRateChangeWeight);
    }
    h.noalias() = rows * rows.transpose();
    if (sigma < 0) h = -h;

    const Vector3d end = x.segment<3>(kStage * k + kPose) + step_ * x.segment<3>(kStage * k + kNext);
    const std::array<Jet, kContacts> gaps = smooth_gaps(problem_.geometry, problem_.smoothing, end, hole_, y);
    Matrix3d by_pose = Matrix3d::Zero();
    for (int i = 0; i < kContacts; ++i) {
      const Jet& gap = gaps[static_cast<std::size_t>(i)];
      by_pose += lambda[i] * gap.along + (by_row[kGaps + i] + lambda[i] * by_row[kProducts + i]) * gap.hessian;
      const Vector3d cross = gap.hessian * y + by_row[kProducts + i] * gap.gradient;
      h.block<1, 3>(kForces + i, kPose) += cross.transpose();
      h.block<1, 3>(kForces + i, kNext) += step_ * cross.transpose();
      h(kForces + i, kForces + i) += 2 * sigma * dt * kForceWeight;
    }
    h.block<3, 3>(kPose, kPose) += by_pose;
    h.block<3, 3>(kNext, kPose) += step_ * by_pose;
    h.block<3, 3>(kNext, kNext) += step_ * step_ * by_pose;
    for (int i = 0; i < kStates; ++i) h(i, i) += on_state(k, i);
    for (int j = 0; j < kStage; ++j) out = std::copy_n(h.data() + j * kStage + j, kStage - j, out);
  }
  for (int i = 0; i < kStates; ++i) *out++ = on_state(problem_.intervals, i);
}

}  // namespace tenon::peg
