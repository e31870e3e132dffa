// A scene with a delta robot as a hybrid DAE of index 1.
//
//     q' = v
//     M v' + C + D + G = B tau + J_v' f + H' lambda          f = sum of contact forces, and the push from outside
//     H v' + Hdot v + 2p H v + p^2 h = 0                     closure, stabilised                                      (delta.md, section 5)
//     tau = the law's torque, or what the sampled controller holds, + u
//     contact force = -k gap - d gap' while touching, 0 while free
//
// x = (q, v, work, [integral], [object], [tool]), y = (lambda, tau, contact forces), u = further motor torques. The controller's memory is
// held by the mode and changes with its clock.
#pragma once

#include "tenon/core/dae.hpp"
#include "tenon/problems/delta/scene.hpp"
#include "tenon/problems/delta/wrist_gimbals.hpp"

namespace tenon::delta {

class SceneDae final : public Dae {
 public:
  /// Throws std::invalid_argument where the wrist starts out of reach or at a singularity of the angles.
  explicit SceneDae(Scene scene);

  int num_states() const override { return num_states_; }
  int num_algebraics() const override { return kTorque + 3 + num_contacts(); }
  int num_inputs() const override { return 3; }
  int num_guards() const override { return num_contacts(); }
  void initial_state(DaeState& state) const override;
  Workspace make_workspace() const override;

  void residual(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef F) const override;
  /// Exact but for the columns of x, which are central differences of the arms' terms and of the continuous law: what Newton's method
  /// needs.
  void jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const override;
  bool has_derivatives() const override { return true; }
  void derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef u, Workspace& workspace, VectorRef xdot,
                   VectorRef y) const override;

  void guards(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef values) const override;
  bool guards_read_derivatives(const DaeMode&) const override { return false; }
  double next_event_time(const DaeState& state) const override;
  Transition transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const override;

  int num_outputs() const override;
  void outputs(const DaeState& state, Workspace& workspace, VectorRef values) const override;

  std::string name() const override { return scene_.name; }
  std::string state_name(int i) const override;
  std::string algebraic_name(int i) const override;
  std::string input_name(int i) const override { return "torque" + std::to_string(i + 1); }
  std::string output_name(int i) const override;
  std::string guard_name(int i) const override { return contact(i).name; }

  const Scene& scene() const { return scene_; }
  /// Kinetic and potential energy of robot, tool and object, and that of the springs, J. What it is beyond the state `work` is the audit's
  /// error.
  double energy(const DaeState& state) const;

 private:
  static constexpr int kTorque = 6;             // first of tau in y
  static constexpr int kContact = kTorque + 3;  // first contact force in y

  struct Touch {
    double gap, rate, force;
    double opening_rate;  // the gripper's part of the rate
  };
  struct Memory;

  int num_held() const;  // reals of the mode, where the controller is sampled
  int num_contacts() const { return static_cast<int>(scene_.contacts.size()); }
  const Contact& contact(int i) const { return scene_.contacts[static_cast<std::size_t>(i)]; }
  bool is_continuous() const { return scene_.control == ControlMode::continuous; }
  bool is_sampled() const { return scene_.control == ControlMode::sampled; }

  /// Forces on the three tips in the arms' frames, N.
  std::array<Vector3, kArms> tip_forces(const DaePoint& at) const;
  Touch touch(int i, const DaeMode& mode, double t, ConstVectorRef x, const Vector3& wrist, const Vector3& velocity) const;
  Vector3 torque(const DaeMode& mode, double t, ConstVectorRef x, const Configuration& at) const;
  Vector3 integral_rate(double t, ConstVectorRef x, const Vector3& wrist) const;
  Vector3 tool_torque(const DaeMode& mode, ConstVectorRef x) const;
  Vector3 tool_acceleration(const DaeMode& mode, ConstVectorRef x) const;
  double object_force(double t, ConstVectorRef x) const;
  double power(const DaeMode& mode, const DaePoint& at, const Vector3& wrist, const Vector3& velocity) const;
  Measurement measure(const DaeState& state) const;
  void tick(DaeState& state, Controller& controller) const;
  bool switch_contact(DaeState& state, int i, bool has_fired, const EventLog& log) const;

  Scene scene_;
  ArmConstants constants_;
  ControllerOptions controller_options_;
  Robot believed_;  // the robot as the controller takes it to be
  Law law_;
  WristGimbals gimbals_;
  Vector9 q_, v_;
  int num_states_ = 19, work_ = 18, integral_ = -1, object_ = -1, tool_ = -1;
};

}  // namespace tenon::delta
