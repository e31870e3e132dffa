// The discrete part of a scene: contacts that begin and end, the controller's clock; and what the record shows.
#include <algorithm>
#include <limits>

#include "tenon/problems/delta/encoder.hpp"
#include "tenon/problems/delta/scene_dae.hpp"

namespace tenon::delta {

namespace {

constexpr int kFree = 0, kTouching = 2;
constexpr int kTorques = 6;  // of the arms' motors, then of the gimbals
constexpr int kHeldState =
    kTorques;  // in mode.held: torques, the controller's state, whether it saturates, ticks so far, torques on the way
constexpr int kHeldSaturated = kHeldState + ControllerState::kSize;
constexpr int kHeldTicks = kHeldSaturated + 1;
constexpr int kHeldQueue = kHeldTicks + 1;

}  // namespace

int SceneDae::num_held() const {
  return kHeldQueue + kTorques * scene_.delay;
}

/// The controller between two calls; what it remembers comes from the mode.
struct SceneDae::Memory final : Dae::Scratch {
  Memory(const Robot& robot, const ControllerOptions& options) : controller(robot, options) {}
  Controller controller;
};

Dae::Workspace SceneDae::make_workspace() const {
  if (!is_sampled()) return nullptr;
  return std::make_unique<Memory>(believed_, controller_options_);
}

void SceneDae::guards(const DaeMode& mode, const DaePoint& at, Workspace&, VectorRef values) const {
  if (num_contacts() == 0) return;
  const Configuration configuration(Vector9(at.x.head<9>()));
  const Vector3 wrist = wrist_position(scene_.robot, configuration);
  const Vector3 velocity = simulation_jacobian(scene_.robot, configuration) * at.x.segment<9>(9);
  for (int i = 0; i < num_contacts(); ++i) {
    const Touch now = touch(i, mode, at.t, at.x, wrist, velocity);
    const bool touches = mode.discrete[static_cast<std::size_t>(i)] != kFree;
    // free: until it overlaps and the spring and damper would push; touching: until they would pull
    values[i] = touches ? now.force : std::max(now.gap, now.gap + contact(i).damping / contact(i).stiffness * now.rate);
  }
}

double SceneDae::next_event_time(const DaeState& state) const {
  if (!is_sampled()) return std::numeric_limits<double>::infinity();
  return state.mode.held[kHeldTicks] * controller_options_.period;
}

bool SceneDae::switch_contact(DaeState& state, int i, bool has_fired, const EventLog& log) const {
  const Configuration configuration(Vector9(state.x.head<9>()));
  const Touch now = touch(i, state.mode, state.t, state.x, wrist_position(scene_.robot, configuration),
                          simulation_jacobian(scene_.robot, configuration) * state.x.segment<9>(9));
  int& mode = state.mode.discrete[static_cast<std::size_t>(i)];
  const double would_push = -contact(i).stiffness * now.gap - contact(i).damping * now.rate;
  const bool changes = has_fired || (mode == kFree ? now.gap < 0 && would_push > 0 : now.force < 0);
  if (!changes) return false;
  const int from = mode;
  const double before = energy(state);
  mode = from == kFree ? kTouching : kFree;
  const double after = energy(state);
  state.x[work_] += after - before;  // what a spring that lets go early still held
  log({.t = state.t,
       .contact = contact(i).name,
       .from = from,
       .to = mode,
       .gap = now.gap,
       .gap_rate_before = now.rate,
       .gap_rate_after = now.rate,
       .energy_before = before,
       .energy_after = after});
  return true;
}

Measurement SceneDae::measure(const DaeState& state) const {
  Measurement m;
  for (int i = 0; i < kArms; ++i) {
    m.angle[i] = quantised(state.x[3 * i], scene_.encoder_bits);
    m.rate[i] = state.x[9 + 3 * i];
  }
  if (tool_ >= 0) {
    for (int i = 0; i < 3; ++i) m.gimbal_angle[i] = quantised(state.x[tool_ + i], scene_.encoder_bits);
    m.gimbal_rate = state.x.segment<3>(tool_ + 3);
  }
  for (int i = 0; i < num_contacts(); ++i) {
    if (contact(i).sensor > 0) m.tactile_left += state.y[kContact + i];
    if (contact(i).sensor < 0) m.tactile_right += state.y[kContact + i];
  }
  return m;
}

void SceneDae::tick(DaeState& state, Controller& controller) const {
  Vector& held = state.mode.held;
  controller.reset(ControllerState::read(held.segment<ControllerState::kSize>(kHeldState)));
  controller.set_reference(scene_.reference.at(state.t));
  controller.set_tool_reference(scene_.tool_reference);
  const Command& command = controller.tick(measure(state));
  controller.state().write(held.segment<ControllerState::kSize>(kHeldState));
  held[kHeldSaturated] = command.saturated;
  Vector6 torques;
  torques << command.torque, command.gimbal_torque;
  const int waiting = kTorques * scene_.delay;
  if (waiting == 0) {
    held.head<kTorques>() = torques;
  } else {
    held.head<kTorques>() = held.segment<kTorques>(kHeldQueue);
    std::copy(held.data() + kHeldQueue + kTorques, held.data() + kHeldQueue + waiting, held.data() + kHeldQueue);
    held.segment<kTorques>(kHeldQueue + waiting - kTorques) = torques;
  }
}

Transition SceneDae::transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const {
  Transition out;
  for (int i = 0; i < num_contacts(); ++i) out.changed |= switch_contact(state, i, std::ranges::find(fired, i) != fired.end(), log);
  if (!out.changed && is_sampled() && state.t >= next_event_time(state) - 1e-9 * controller_options_.period) {
    if (state.mode.held[kHeldTicks] == 0 && scene_.delay > 0) {  // what holds the weight is on its way from before
      const Configuration at(Vector9(state.x.head<9>()));
      Vector6 holding = Vector6::Zero();
      holding.head<3>() = gravity_torque(law_.constants(), at, Motion(scene_.robot, at));
      state.mode.held.tail(kTorques * scene_.delay) = holding.replicate(scene_.delay, 1);
    }
    tick(state, static_cast<Memory&>(*workspace).controller);
    ++state.mode.held[kHeldTicks];
    out.changed = true;
  }
  return out;
}

double SceneDae::energy(const DaeState& state) const {
  const Configuration configuration(Vector9(state.x.head<9>()));
  double sum = kinetic_energy(constants_, configuration, state.x.segment<9>(9)) + potential_energy(constants_, configuration);
  const Vector3 wrist = wrist_position(scene_.robot, configuration);
  for (int i = 0; i < num_contacts(); ++i) {
    if (state.mode.discrete[static_cast<std::size_t>(i)] == kFree) continue;
    const double gap = touch(i, state.mode, state.t, state.x, wrist, Vector3::Zero()).gap;
    sum += contact(i).stiffness * gap * gap / 2;
  }
  if (object_ >= 0) {
    const double stretch = state.x[object_] - scene_.object.position, rate = state.x[object_ + 1];
    sum += (scene_.object.mass * rate * rate + scene_.object.stiffness * stretch * stretch) / 2;
  }
  if (tool_ >= 0) sum += gimbals_.kinetic_energy(state.x.segment<3>(tool_), state.x.segment<3>(tool_ + 3));
  return sum;
}

// --- the record ------------------------------------------------------------------------------------------------------------------------

int SceneDae::num_outputs() const {
  return 7 + 2 * num_contacts() + (is_sampled() ? 2 : 0) + 5;
}

void SceneDae::outputs(const DaeState& state, Workspace&, VectorRef values) const {
  const Configuration configuration(Vector9(state.x.head<9>()));
  const Vector3 wrist = wrist_position(scene_.robot, configuration);
  const Motion motion(scene_.robot, configuration);
  int k = 0;
  const auto add = [&](double value) { values[k++] = value; };
  Reference reference = scene_.reference.at(state.t);
  const double shift = is_sampled() ? ControllerState::read(state.mode.held.segment<ControllerState::kSize>(kHeldState)).shift : 0;
  reference.position += shift * controller_options_.tactile_axis;
  for (int i = 0; i < 3; ++i) add(wrist[i]);
  for (int i = 0; i < 3; ++i) add(reference.position[i]);
  add((reference.position - wrist).norm());
  for (int i = 0; i < num_contacts(); ++i) add(touch(i, state.mode, state.t, state.x, wrist, Vector3::Zero()).gap);
  for (int i = 0; i < num_contacts(); ++i) add(state.mode.discrete[static_cast<std::size_t>(i)]);
  if (is_sampled()) {
    add(shift);
    add(state.mode.held[kHeldSaturated]);
  }
  const double total = energy(state);
  add(total);
  add(total - state.x[work_]);
  add(closure(scene_.robot, configuration).lpNorm<Eigen::Infinity>());
  add(motion.b.cwiseAbs().minCoeff() / scene_.robot.proximal_length);
  add(motion.det_a);
}

std::string SceneDae::output_name(int i) const {
  static const char* const position[] = {"zx", "zy", "zz", "rx", "ry", "rz", "tracking_error"};
  if (i < 7) return position[i];
  i -= 7;
  const int n = num_contacts();
  if (i < n) return "gap_" + contact(i).name;
  if (i < 2 * n) return "mode_" + contact(i - n).name;
  i -= 2 * n;
  if (is_sampled()) {
    if (i < 2) return i == 0 ? "shift" : "saturated";
    i -= 2;
  }
  static const char* const rest[] = {"energy", "energy_error", "closure", "type_1", "det_a"};
  return rest[i];
}

std::string SceneDae::state_name(int i) const {
  const auto arm = [](const char* symbol, int k) { return symbol + std::to_string(k / 3 + 1) + std::to_string(k % 3 + 1); };
  if (i < 9) return arm("q", i);
  if (i < 18) return arm("v", i - 9);
  if (i == work_) return "work";
  static const char* const integral[] = {"integral_x", "integral_y", "integral_z"};
  static const char* const object[] = {"object", "object_rate"};
  static const char* const tool[] = {"yaw", "pitch", "roll", "yaw_rate", "pitch_rate", "roll_rate"};
  if (integral_ >= 0 && i < integral_ + 3) return integral[i - integral_];
  if (object_ >= 0 && i < object_ + 2) return object[i - object_];
  return tool[i - tool_];
}

std::string SceneDae::algebraic_name(int i) const {
  if (i < kTorque) return "lambda" + std::to_string(i + 1);
  if (i < kContact) return "tau" + std::to_string(i - kTorque + 1);
  return "lambda_" + contact(i - kContact).name;
}

}  // namespace tenon::delta
