// dF/d(x, y) + alpha dF/dxdot of a scene, block by block.
//
//             q     v            others                 lambda   tau   contacts
//     q     [ a     -1                                                          ]      a: alpha times identity
//     v     [ *     * + a M                             -H'      -B    -J_v' n  ]      *: central differences, all arms at once: an arm's
//     work  [ (push, dampers)    a, object                       -v'            ]         terms know its own angles only
//     other [ * (integral)       a + its own                           (object) ]
//     h     [ *     * + a H                                                     ]
//     tau   [ * (continuous law: differences)                    1              ]
//     touch [ *     *            (object)                              1        ]
#include <cmath>

#include "tenon/problems/delta/scene_dae.hpp"

namespace tenon::delta {

namespace {

constexpr double kStep = 6e-6;  // cube root of the rounding

/// What depends on one arm's angles and rates, in world axes where it is a vector of space.
struct ArmTerms {
  Vector3 balance, tip, wrist, velocity;

  ArmTerms operator-(const ArmTerms& other) const {
    return {balance - other.balance, tip - other.tip, wrist - other.wrist, velocity - other.velocity};
  }
};

}  // namespace

void SceneDae::jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace&, std::span<double> values) const {
  const Robot& robot = scene_.robot;
  const int n = num_states_ + num_algebraics(), h = num_states_, tau = num_states_ + kTorque, touching = num_states_ + kContact;
  Eigen::Map<Eigen::MatrixXd> J(values.data(), n, n);
  J.setZero();
  J.diagonal().head(num_states_).setConstant(alpha);
  const std::array<Vector3, kArms> force = tip_forces(at);
  const Vector9 q = at.x.head<9>(), v = at.x.segment<9>(9);
  const Configuration configuration(q);

  const Matrix39 j_v = simulation_jacobian(robot, configuration);
  const Vector3 wrist = wrist_position(robot, configuration), velocity = j_v * v, push = scene_.push.at(at.t);
  const auto touches = [&](int c) { return mode.discrete[static_cast<std::size_t>(c)] != 0; };
  const auto touch_at = [&](int c) { return touch(c, mode, at.t, at.x, wrist, velocity); };

  const auto terms = [&](const Configuration& where, const Vector9& rates, int i) {
    const Vector3 rate = rates.segment<3>(3 * i);
    const ArmResidual arm = arm_residual(robot, constants_, where[i], rate, at.xdot.segment<3>(9 + 3 * i), force[std::size_t(i)]);
    return ArmTerms{arm.balance, to_world(i, arm.tip), to_world(i, where[i].wrist(robot)), to_world(i, where[i].jacobian(robot) * rate)};
  };
  /// The column of an angle or a rate of arm i, `change` over a step of unit length.
  const auto write = [&](int column, int i, const ArmTerms& change) {
    J.block<3, 1>(9 + 3 * i, column) += change.balance;
    if (i == 0)
      J.block<3, 1>(h, column) = J.block<3, 1>(h + 3, column) = change.tip;
    else
      J.block<3, 1>(h + 3 * (i - 1), column) = -change.tip;
    if (integral_ >= 0) J.block<3, 1>(integral_, column) = change.wrist / 3;
    if (!scene_.push.on_object) J(work_, column) -= push.dot(change.velocity) / 3;
    for (int c = 0; c < num_contacts(); ++c) {
      if (!touches(c)) continue;
      const Contact& on = contact(c);
      const double rate = on.normal.dot(change.velocity) / 3;
      J(touching + c, column) = on.stiffness * on.normal.dot(change.wrist) / 3 + on.damping * rate;
      J(work_, column) += 2 * on.damping * touch_at(c).rate * rate;
    }
  };
  const auto scaled = [](ArmTerms t, double factor) {
    t.balance *= factor, t.tip *= factor, t.wrist *= factor, t.velocity *= factor;
    return t;
  };
  for (int k = 0; k < 3; ++k) {
    const Vector9 step = kStep * Vector3::Unit(k).replicate<kArms, 1>();
    const Configuration ahead(Vector9(q + step)), behind(Vector9(q - step));
    for (int i = 0; i < kArms; ++i) {
      write(3 * i + k, i, scaled(terms(ahead, v, i) - terms(behind, v, i), 1 / (2 * kStep)));
      J(3 * i + k, 9 + 3 * i + k) = -1;
    }
    for (int i = 0; i < kArms; ++i) {
      // quadratic in the rates: the central difference is exact at any step
      write(9 + 3 * i + k, i,
            scaled(terms(configuration, v + Vector9::Unit(3 * i + k), i) - terms(configuration, v - Vector9::Unit(3 * i + k), i), 0.5));
      J(9 + 3 * i + k, 9 + 3 * i + k) -= alpha;
      J(work_, 9 + 3 * i + k) += 2 * constants_.damping[k] * v[3 * i + k];
    }
  }
  for (int i = 0; i < kArms; ++i) {
    J.block<3, 3>(9 + 3 * i, 9 + 3 * i) += alpha * ArmInertia(constants_, configuration[i]).matrix();
    J(9 + 3 * i, tau + i) = -1;
    J(work_, 9 + 3 * i) -= at.y[kTorque + i];
    J(work_, tau + i) = -v[3 * i];
  }
  const Matrix69 closing = closure_jacobian(robot, configuration);
  J.block<6, 9>(h, 9) += alpha * closing;
  J.block<9, 6>(9, h) = -closing.transpose();
  J.bottomRightCorner(3 + num_contacts(), 3 + num_contacts()).setIdentity();
  for (int c = 0; c < num_contacts(); ++c) {
    J.block<9, 1>(9, touching + c) = -j_v.transpose() * contact(c).normal;
    if (touches(c)) J(work_, touching + c) = touch_at(c).opening_rate;
  }
  if (object_ >= 0) {
    const Object& object = scene_.object;
    J(object_, object_ + 1) = -1;
    J(object_ + 1, object_) = object.stiffness;
    J(object_ + 1, object_ + 1) = alpha * object.mass + object.damping;
    J(work_, object_ + 1) = 2 * object.damping * at.x[object_ + 1] - (scene_.push.on_object ? push[0] : 0);
    for (int c = 0; c < num_contacts(); ++c) {
      if (!contact(c).is_finger) continue;
      const double along = contact(c).normal.dot(controller_options_.tactile_axis);
      J(object_ + 1, touching + c) = along;
      if (!touches(c)) continue;
      J(touching + c, object_) = -contact(c).stiffness * along;
      J(touching + c, object_ + 1) = -contact(c).damping * along;
      J(work_, object_ + 1) -= 2 * contact(c).damping * touch_at(c).rate * along;
    }
  }
  Vector x = at.x;
  const auto difference = [&](int k, auto&& f) {
    const double step = kStep * (1 + std::abs(x[k]));
    x[k] = at.x[k] + step;
    const Vector3 plus = f();
    x[k] = at.x[k] - step;
    const Vector3 minus = f();
    x[k] = at.x[k];
    return Vector3((plus - minus) / (2 * step));
  };
  if (tool_ >= 0) {
    J.block<3, 3>(tool_, tool_ + 3) = -Matrix3::Identity();
    for (int k = tool_; k < tool_ + 6; ++k) {
      J.block<3, 1>(tool_ + 3, k) -= difference(k, [&] { return tool_acceleration(mode, x); });
      J(work_, k) -= difference(k, [&] { return Vector3(tool_torque(mode, x).cwiseProduct(x.segment<3>(tool_ + 3))); }).sum();
    }
  }
  if (is_continuous()) {
    for (int k = 0; k < integral_ + 3; ++k) {
      J.block<3, 1>(tau, k) = -difference(k, [&] { return torque(mode, at.t, x, Configuration(Vector9(x.head<9>()))); });
    }
  }
}

}  // namespace tenon::delta
