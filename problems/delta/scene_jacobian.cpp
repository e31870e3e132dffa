// dF/d(x, y) + alpha dF/dxdot of a scene, block by block.
//
//             q     v            others                 lambda   tau   contacts
//     q     [ a     -1                                                          ]      a: alpha times identity
//     v     [ *     * + a M                             -H'      -B    -J_v' n  ]      *: central differences, all arms at once: an arm's
//     other [ * (integral)       a + its own                           (object) ]         terms know its own angles only
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
    for (int c = 0; c < num_contacts(); ++c) {
      if (mode.discrete[static_cast<std::size_t>(c)] == 0) continue;
      const Contact& on = contact(c);
      J(touching + c, column) = (on.stiffness * on.normal.dot(change.wrist) + on.damping * on.normal.dot(change.velocity)) / 3;
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
    }
  }
  for (int i = 0; i < kArms; ++i) {
    J.block<3, 3>(9 + 3 * i, 9 + 3 * i) += alpha * ArmInertia(constants_, configuration[i]).matrix();
    J(9 + 3 * i, tau + i) = -1;
  }
  const Matrix69 closing = closure_jacobian(robot, configuration);
  J.block<6, 9>(h, 9) += alpha * closing;
  J.block<9, 6>(9, h) = -closing.transpose();
  J.bottomRightCorner(3 + num_contacts(), 3 + num_contacts()).setIdentity();
  const Matrix39 j_v = simulation_jacobian(robot, configuration);
  for (int c = 0; c < num_contacts(); ++c) J.block<9, 1>(9, touching + c) = -j_v.transpose() * contact(c).normal;
  if (object_ >= 0) {
    const Object& object = scene_.object;
    J(object_, object_ + 1) = -1;
    J(object_ + 1, object_) = object.stiffness;
    J(object_ + 1, object_ + 1) = alpha * object.mass + object.damping;
    for (int c = 0; c < num_contacts(); ++c) {
      if (!contact(c).is_finger) continue;
      const double along = contact(c).normal.dot(controller_options_.tactile_axis);
      const bool touches = mode.discrete[static_cast<std::size_t>(c)] != 0;
      J(object_ + 1, touching + c) = along;
      J(touching + c, object_) = touches ? -contact(c).stiffness * along : 0;
      J(touching + c, object_ + 1) = touches ? -contact(c).damping * along : 0;
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
    for (int k = 0; k < 6; ++k) J.block<3, 1>(tool_ + 3, tool_ + k) -= difference(tool_ + k, [&] { return tool_acceleration(x); });
  }
  if (is_continuous()) {
    for (int k = 0; k < integral_ + 3; ++k) {
      J.block<3, 1>(tau, k) = -difference(k, [&] { return torque(mode, at.t, x, Configuration(Vector9(x.head<9>()))); });
    }
  }
}

}  // namespace tenon::delta
