#include "tenon/problems/delta/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::delta {

namespace {

/// dq2, dq3 that turn the distal link by the displacement `delta` of its end, m.
inline Eigen::Vector2d distal_turn(const Robot& robot, const ArmConfiguration& arm, const Vector3& delta) {
  return {arm.d2().dot(delta) / robot.distal_length, arm.d3().dot(delta) / (robot.distal_length * arm.s2)};
}

}  // namespace

Vector6 closure(const Robot& robot, const Configuration& at) {
  const Vector3 first = at[0].wrist(robot);
  Vector6 h;
  for (int i = 1; i < kArms; ++i) h.segment<3>(3 * (i - 1)) = first - to_world(i, at[i].wrist(robot));
  return h;
}

Matrix69 closure_jacobian(const Robot& robot, const Configuration& at) {
  Matrix69 h = Matrix69::Zero();
  const Matrix3 first = at[0].jacobian(robot);
  h.block<3, 3>(0, 0) = h.block<3, 3>(3, 0) = first;
  for (int i = 1; i < kArms; ++i) {
    const Matrix3 p = at[i].jacobian(robot);
    for (int k = 0; k < 3; ++k) h.block<3, 1>(3 * (i - 1), 3 * i + k) = -to_world(i, p.col(k));
  }
  return h;
}

Vector6 closure_bias(const Robot& robot, const Configuration& at, const Vector9& v) {
  const Vector3 first = at[0].bias(robot, v.head<3>());
  Vector6 bias;
  for (int i = 1; i < kArms; ++i) bias.segment<3>(3 * (i - 1)) = first - to_world(i, at[i].bias(robot, v.segment<3>(3 * i)));
  return bias;
}

Matrix39 simulation_jacobian(const Robot& robot, const Configuration& at) {
  Matrix39 j;
  for (int i = 0; i < kArms; ++i) {
    const Matrix3 p = at[i].jacobian(robot);
    for (int k = 0; k < 3; ++k) j.col(3 * i + k) = to_world(i, p.col(k)) / 3;
  }
  return j;
}

Vector3 wrist_position(const Robot& robot, const Configuration& at) {
  return (at[0].wrist(robot) + to_world(1, at[1].wrist(robot)) + to_world(2, at[2].wrist(robot))) / 3;
}

Vector9 angles(const Configuration& at) {
  Vector9 q;
  for (int i = 0; i < kArms; ++i) {
    const ArmConfiguration& arm = at[i];
    q.segment<3>(3 * i) << std::atan2(arm.s1, arm.c1), std::atan2(arm.s2, arm.c2), std::atan2(arm.s3, arm.c3);
  }
  return q;
}

Motion::Motion(const Robot& robot, const Configuration& at) {
  for (int i = 0; i < kArms; ++i) {
    a.row(i) = to_world(i, at[i].d());
    b[i] = robot.proximal_length * at[i].d().dot(at[i].e1());  // (3.2)
  }
  const Vector3 a1 = a.row(0), a2 = a.row(1), a3 = a.row(2);
  const Vector3 a23 = a2.cross(a3);
  det_a = a1.dot(a23);
  a_inverse.col(0) = a23 / det_a;
  a_inverse.col(1) = a3.cross(a1) / det_a;
  a_inverse.col(2) = a1.cross(a2) / det_a;
  jacobian = a_inverse * b.asDiagonal();
  for (int i = 0; i < kArms; ++i) {
    // Gamma_i: what the wrist's motion, seen from the elbow's, asks of the distal link                                          (3.4)
    Matrix3& g = gamma[std::size_t(i)];
    for (int k = 0; k < 3; ++k) {
      Vector3 end = to_arm(i, jacobian.col(k));
      if (k == i) end -= robot.proximal_length * at[i].e1();
      g(0, k) = k == i;
      g.block<2, 1>(1, k) = distal_turn(robot, at[i], end);
    }
  }
}

Singularity Motion::singularity(const Robot& robot, const Configuration& at) const {
  return {b.cwiseAbs().minCoeff() / robot.proximal_length, std::abs(det_a), std::min({at[0].s2, at[1].s2, at[2].s2})};
}

Matrix93 Motion::gamma_matrix() const {
  Matrix93 g;
  for (int i = 0; i < kArms; ++i) g.middleRows<3>(3 * i) = gamma[std::size_t(i)];
  return g;
}

Vector9 Motion::rates(const Vector3& y_rate) const {
  Vector9 v;
  for (int i = 0; i < kArms; ++i) v.segment<3>(3 * i).noalias() = gamma[std::size_t(i)] * y_rate;
  return v;
}

MotionBias motion_bias(const Robot& robot, const Configuration& at, const Motion& motion, const Vector9& v) {
  // along a distal link the rates alone decide:  (R_i d_i) . z'' = d_i . Pdot v                                                   (3.5)
  std::array<Vector3, kArms> bias;
  Vector3 along;
  for (int i = 0; i < kArms; ++i) {
    bias[std::size_t(i)] = at[i].bias(robot, v.segment<3>(3 * i));
    along[i] = at[i].d().dot(bias[std::size_t(i)]);
  }
  MotionBias out;
  out.wrist = motion.a_inverse * along;
  for (int i = 0; i < kArms; ++i) {
    out.gamma[3 * i] = 0;
    out.gamma.segment<2>(3 * i + 1) = distal_turn(robot, at[i], to_arm(i, out.wrist) - bias[std::size_t(i)]);
  }
  return out;
}

namespace {

/// The distal angles that join an elbow to the wrist.
inline void aim_distal_link(const Robot& robot, int i, const Vector3& wrist, ArmConfiguration& arm) {
  const Vector3 d = (to_arm(i, wrist) - Vector3(0, robot.radial_offset(), 0) - robot.proximal_length * arm.e()) / robot.distal_length;
  arm.c2 = d[1];
  arm.s2 = std::sqrt(d[0] * d[0] + d[2] * d[2]);
  const double inverse = arm.s2 > 0 ? 1 / arm.s2 : 0;
  arm.s3 = d[0] * inverse;
  arm.c3 = arm.s2 > 0 ? d[2] * inverse : 1;
}

}  // namespace

int place_wrist(const Robot& robot, const Vector3& z, Configuration& at) {
  const double l1 = robot.proximal_length, l2 = robot.distal_length;
  for (int i = 0; i < kArms; ++i) {
    const Vector3 w = to_arm(i, z) - Vector3(0, robot.radial_offset(), 0);
    // |w - l1 e|^2 = l2^2:  w_y c1 + w_z s1 = s, of whose two solutions the elbow is the outer one                                (1.5)
    const double s = (w.squaredNorm() + l1 * l1 - l2 * l2) / (2 * l1), rr = w[1] * w[1] + w[2] * w[2], height_2 = rr - s * s;
    if (!(height_2 >= 0)) return i;
    ArmConfiguration& arm = at.arm[std::size_t(i)];
    const double height = std::sqrt(height_2), inverse = rr > 0 ? 1 / rr : 0;
    arm.c1 = (w[1] * s + w[2] * height) * inverse;
    arm.s1 = rr > 0 ? (w[2] * s - w[1] * height) * inverse : -1;
    aim_distal_link(robot, i, z, arm);
  }
  return -1;
}

Inverse inverse_kinematics(const Robot& robot, const Vector3& z) {
  Inverse out;
  Configuration at;
  out.unreachable_arm = place_wrist(robot, z, at);
  if (out.ok()) out.q = angles(at);
  return out;
}

Forward forward_kinematics(const Robot& robot, const Vector3& y) {
  Forward out;
  Eigen::Array<double, 3, 1> sine, cosine;
  sine_and_cosine<double, 3>(y.array(), sine, cosine);
  std::array<Vector3, kArms> elbow;
  for (int i = 0; i < kArms; ++i) {
    ArmConfiguration& arm = out.at.arm[std::size_t(i)];
    arm.c1 = cosine[i];
    arm.s1 = sine[i];
    elbow[std::size_t(i)] = to_world(i, Vector3(0, robot.radial_offset(), 0) + robot.proximal_length * arm.e());
  }
  // u: from elbow 1 to the centre of the circle through all three; the wrist stands above it along the normal n                 (1.6)
  const Vector3 p = elbow[1] - elbow[0], r = elbow[2] - elbow[0], n = p.cross(r);
  const double l2 = robot.distal_length, nn = n.squaredNorm();
  if (!(nn > kSingular * kSingular * l2 * l2 * l2 * l2)) return out;
  const Vector3 u = (p.squaredNorm() * r.cross(n) + r.squaredNorm() * n.cross(p)) / (2 * nn);
  const double height_2 = l2 * l2 - u.squaredNorm();
  if (!(height_2 >= 0)) {
    out.status = ForwardStatus::unreachable;
    return out;
  }
  const double height = std::sqrt(height_2 / nn);
  out.wrist = elbow[0] + u + (n[2] >= 0 ? height : -height) * n;
  for (int i = 0; i < kArms; ++i) aim_distal_link(robot, i, out.wrist, out.at.arm[std::size_t(i)]);
  const double det_a = height * nn / (l2 * l2 * l2);
  out.status = det_a > kSingular ? ForwardStatus::solved : ForwardStatus::singular;
  return out;
}

Forward forward_newton(const Robot& robot, const Vector3& y, Vector9& guess) {
  constexpr int kMostSteps = 20;
  constexpr double kRounding = 1e-14;  // of a length in parts of l1 + l2
  Forward out;
  for (int i = 0; i < kArms; ++i) guess[3 * i] = y[i];
  for (int step = 0;; ++step) {
    out.at = Configuration(guess);
    const Vector6 h = closure(robot, out.at);
    out.wrist = wrist_position(robot, out.at);
    const Motion motion(robot, out.at);
    const Singularity measure = motion.singularity(robot, out.at);
    if (!guess.allFinite() || !(std::min(measure.type_2, measure.s2) > kSingular)) {
      out.status = ForwardStatus::singular;
      return out;
    }
    if (h.lpNorm<Eigen::Infinity>() <= kRounding * (robot.proximal_length + robot.distal_length)) {
      out.status = ForwardStatus::solved;
      return out;
    }
    if (step == kMostSteps) {
      out.status = ForwardStatus::iteration_limit;
      return out;
    }
    // h_x dx = -h, taken apart: all ends meet in z, where (R_i d_i) . (z - R_i psi_i) = 0                                         (1.7)
    Vector3 along;
    for (int i = 0; i < kArms; ++i) along[i] = motion.a.row(i) * to_world(i, out.at[i].wrist(robot));
    const Vector3 z = motion.a_inverse * along;
    for (int i = 0; i < kArms; ++i) {
      guess.segment<2>(3 * i + 1) += distal_turn(robot, out.at[i], to_arm(i, z) - out.at[i].wrist(robot));
    }
  }
}

namespace {

/// The point nearest to z that arm i reaches: between l2 of the nearest and l2 of the farthest point of the elbow's circle.
Vector3 nearest_of_arm(const Robot& robot, int i, const Vector3& z) {
  const double l1 = robot.proximal_length, l2 = robot.distal_length;
  const Vector3 offset(0, robot.radial_offset(), 0);
  const Vector3 w = to_arm(i, z) - offset;
  const double r = std::hypot(w[1], w[2]);
  const Vector3 out = r > 0 ? Vector3(0, w[1] / r, w[2] / r) : Vector3(0, 0, 1);
  const Vector3 from_near = w - l1 * out, from_far = w + l1 * out;
  if (from_near.norm() > l2) return to_world(i, offset + l1 * out + l2 * from_near.normalized());
  if (from_far.norm() < l2) return to_world(i, offset - l1 * out + l2 * from_far.normalized());
  return z;
}

}  // namespace

double distance_to_workspace(const Robot& robot, const Vector3& z) {
  // Dykstra's projections: onto one arm's reach after the other, each with the correction of its last turn
  constexpr int kMostTurns = 2000;
  std::array<Vector3, kArms> correction{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  Vector3 x = z;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Vector3 before = x;
    for (int i = 0; i < kArms; ++i) {
      Vector3& c = correction[std::size_t(i)];
      const Vector3 from = x + c;
      x = nearest_of_arm(robot, i, from);
      c = from - x;
    }
    if ((x - before).norm() <= 1e-14 * robot.distal_length && turn > 0) break;
  }
  return (x - z).norm();
}

}  // namespace tenon::delta
