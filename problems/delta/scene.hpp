// A scene with a delta robot, as data: what it should do, what controls it, what it touches. SceneDae gives it equations.
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/delta/controller.hpp"
#include "tenon/problems/delta/reference_path.hpp"

namespace tenon::delta {

/// A spring and a damper that only push:  lambda = max(0, -stiffness gap - damping gap').
struct Contact {
  std::string name;
  double stiffness = 1e4;    // N/m
  double damping = 20;       // N s/m
  Vector3 normal{0, 0, -1};  // unit: the push on the wrist
  double offset = 0;         // m: gap = normal . z + offset + opening(t) - (normal . object)
  bool is_finger = false;    // of the gripper: it closes by `opening`, and what it touches is the object
  int sensor = 0;            // +1: read as s_L, -1: as s_R, 0: nobody reads it
};

/// Fingers close from one half-width to another, at a constant speed.
struct Gripper {
  double from = 0, to = 0;    // m: half of the free width between the fingers
  double begin = 0, end = 0;  // s
  double opening(double t) const;
};

/// What the fingers hold: it moves along the tactile axis on a spring and a damper.
struct Object {
  double mass = 0;       // kg; 0: there is none
  double position = 0;   // m along the axis, where the spring is at rest, and at the start
  double stiffness = 0;  // N/m
  double damping = 0;    // N s/m
};

/// A force from outside, on the wrist or on the object.
struct Push {
  Vector3 constant{0, 0, 0};     // N
  Vector3 amplitude{0, 0, 0};    // N, of a sine whose frequency rises from f_0 to f_1 by the same factor in equal times
  double from = 1, to = 1;       // Hz
  double duration = 1;           // s
  bool on_object = false;        // along the axis, what stands in the vectors' first place
  double phase(double t) const;  // of the sine, rad
  Vector3 at(double t) const;
};

enum class ControlMode { none, continuous, sampled };

struct Scene {
  std::string name;
  Robot robot;
  Vector3 position{0, 0, 0};  // of the wrist at the start, m
  Vector3 velocity{0, 0, 0};  // m/s
  ReferencePath reference;
  ControlMode control = ControlMode::none;
  ControllerOptions controller;
  double controller_payload = 0;  // kg: what the controller takes the payload to be
  int delay = 0;                  // ticks between a measurement and its torque, beyond the hold
  int encoder_bits = 0;           // of a turn; 0: exact angles
  std::vector<Contact> contacts;
  Gripper gripper;
  Object object;
  Push push;
  bool has_tool = false;            // the gimbals move
  Vector3 tool_angle{0, 0, 0};      // of the gimbals at the start, rad
  Vector3 tool_reference{0, 0, 0};  // rad
  double duration = 1;              // s
  double rtol = 1e-8;
  double output_step = 0.01;  // s
};

}  // namespace tenon::delta
