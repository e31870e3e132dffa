// The delta robot and its spherical wrist as the plant of a control loop: held torques and a force from outside, one tick at a time.
//
//     Plant plant(load_robot("delta"), {.tool = {0, 0, 0.04}});     // throws where the robot or an option makes no sense
//     plant.place({0, 0, 0.4}, {0, 0, 0});                          // the wrist (m), the gimbals (rad), at rest; false: out of reach
//     for (;;) {                                                    // a tick is `period` long
//       controller reads plant.motors(), plant.motor_rates(), plant.gimbals(), plant.gimbal_rates()
//       plant.step(torque, gimbal_torque, [&](const ToolMotion& tool) { return Wrench{contact forces at the tool's point}; });
//       record plant.angles() (q11 .. q33), plant.closure() (h, zero but for rounding), plant.tool()
//     }
//
// Classical Runge-Kutta of order 4 at a fixed micro-step, in the coordinates of the wrist and the gimbals (wrist_dynamics.hpp,
// wrist_gimbals.hpp). 20 us are 1/90 of a radian of 2e5 N/m on 0.6 kg; stable while damping/mass stays below 2.7/micro_step. The force may
// depend on pose and velocity only; where it jumps, as a damper's does at touch, it may come up to a micro-step late. The tool is
// balanced about the gimbals' centre; its mass is in the robot's payload. step() neither allocates nor throws; a Plant is a value: copy
// it to keep or to branch a run.
#pragma once

#include "tenon/problems/delta/wrist_dynamics.hpp"
#include "tenon/problems/delta/wrist_gimbals.hpp"

namespace tenon::delta {

/// The tool's point and frame, in world axes (z down).
struct ToolMotion {
  Vector3 position{0, 0, 0};               // m
  Matrix3 attitude = Matrix3::Identity();  // tool to world
  Vector3 velocity{0, 0, 0};               // of the point, m/s
  Vector3 angular_velocity{0, 0, 0};       // rad/s
};

/// What acts on the tool from outside, at its point, in world axes.
struct Wrench {
  Vector3 force{0, 0, 0};   // N
  Vector3 moment{0, 0, 0};  // N m
};

struct PlantOptions {
  double period = 1e-3;      // s, of one step()
  double micro_step = 2e-5;  // s, at most
  Vector3 tool{0, 0, 0};     // m: the tool's point from the gimbals' centre, in the tool's frame
};

class Plant {
 public:
  /// Throws std::invalid_argument, naming what makes no sense. A robot whose gimbal_inertia is zero holds its tool fixed.
  Plant(const Robot& robot, const PlantOptions& options);

  /// False, and nothing changes, where an arm does not reach the wrist or it is at a singularity of the angles.
  bool place(const Vector3& wrist, const Vector3& gimbals, const Vector3& velocity = Vector3::Zero(),
             const Vector3& gimbal_rates = Vector3::Zero());

  /// One period under torques (N m) that are cut to the robot's limits. False where the wrist would leave the reach of its arms or a force
  /// is not finite: the state is then the last good one.
  template <class Force>
  bool step(const Vector3& torque, const Vector3& gimbal_torque, const Force& force) {
    hold(torque, gimbal_torque);
    bool ok = true;
    for (int k = 0; k < micro_steps_ && ok; ++k) ok = micro_step(force);
    return ok;
  }

  const Vector3& torque() const { return torque_; }  // as cut to the limits
  const Vector3& gimbal_torque() const { return gimbal_torque_; }

  Vector3 wrist() const { return state_.position.head<3>(); }
  Vector3 velocity() const { return state_.velocity.head<3>(); }
  Vector3 gimbals() const { return state_.position.tail<3>(); }
  Vector3 gimbal_rates() const { return state_.velocity.tail<3>(); }
  ToolMotion tool() const { return pose(state_).tool; }

  Vector9 angles() const;  // q11, q12, ..., q33, rad
  Vector9 rates() const;   // rad/s
  Vector3 motors() const;
  Vector3 motor_rates() const;
  Vector6 closure() const;  // h, m
  double energy() const;    // kinetic and potential, J; z down

  const Robot& robot() const { return robot_; }
  const PlantOptions& options() const { return options_; }

 private:
  /// Of the wrist, then of the gimbals.
  struct State {
    Vector6 position = Vector6::Zero();
    Vector6 velocity = Vector6::Zero();
  };

  struct Pose {
    ToolMotion tool;
    Matrix3 axes;  // of the gimbals
  };

  void hold(const Vector3& torque, const Vector3& gimbal_torque);
  Pose pose(const State& at) const;
  Vector6 acceleration(const State& at, const Pose& pose, const Wrench& wrench) const;

  template <class Force>
  bool micro_step(const Force& force) {
    const double h = micro_step_;
    const auto a = [&](const State& at) {
      const Pose pose = this->pose(at);
      return acceleration(at, pose, force(pose.tool));
    };
    const Vector6& p = state_.position;
    const Vector6& v = state_.velocity;
    const Vector6 a1 = a(state_);
    const State second{p + h / 2 * v, v + h / 2 * a1};
    const Vector6 a2 = a(second);
    const State third{p + h / 2 * second.velocity, v + h / 2 * a2};
    const Vector6 a3 = a(third);
    const State fourth{p + h * third.velocity, v + h * a3};
    const Vector6 a4 = a(fourth);
    const State next{p + h * v + h * h / 6 * (a1 + a2 + a3), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)};
    if (!(next.position.allFinite() && next.velocity.allFinite())) return false;
    state_ = next;
    return true;
  }

  Robot robot_;
  ArmConstants constants_;
  WristGimbals gimbals_;
  PlantOptions options_;
  int micro_steps_;
  double micro_step_;
  bool has_gimbals_;
  Vector3 torque_{0, 0, 0}, gimbal_torque_{0, 0, 0};
  State state_;
};

}  // namespace tenon::delta
