// The discrete part of a mission: what breaks, the wind, and the control tick from a noisy pose to commands; and what the record shows.
#include <fmt/format.h>

#include <algorithm>

#include "tenon/problems/flight/flight_dae.hpp"
#include "tenon/problems/flight/noise.hpp"

namespace tenon::flight {

namespace {

constexpr double kSameInstant = 1e-9;  // of a period
constexpr double kShort = 1e-2;        // relative, of a wrench that cannot be had
constexpr double kAtLimit = 1e-6;      // of throttles, angles in rad, and relative of rates

}  // namespace

/// What stands beside the mode. What the controller remembers comes from there; the allocator remembers by itself.
struct FlightDae::Memory final : Dae::Scratch {
  Memory(const Mission& mission, const MakeAllocator& make)
      : controller(mission.controller),
        make_allocator(make),
        vehicle(mission.vehicle),
        knows(mission.failures.size()) {}

  PoseController controller;
  const MakeAllocator& make_allocator;
  const Vehicle& vehicle;
  std::unique_ptr<Allocator> allocator;
  std::vector<char> knows;  // of which failures
  int next_tick = -1;
};

Dae::Workspace FlightDae::make_workspace() const { return std::make_unique<Memory>(mission_, make_allocator_); }

double FlightDae::next_event_time(const DaeState& state) const { return state.mode.discrete[Layout::kTicks] * mission_.controller.period; }

Transition FlightDae::transition(DaeState& state, std::span<const int>, Workspace& workspace, const EventLog& log) const {
  if (state.t < next_event_time(state) - kSameInstant * mission_.controller.period) return {};
  if (const std::string why = lost(state); !why.empty()) return {.failure = why};
  state.x.segment<4>(kAttitude).normalize();
  fail(state, log);
  blow(state);
  const int n = rotors_.size();
  const Vector last_angles = state.mode.held.segment(at_.allocated() + n, n);
  tick(state, static_cast<Memory&>(*workspace));
  watch_limits(state, last_angles, log);
  ++state.mode.discrete[Layout::kTicks];
  return {.changed = true};
}

std::string FlightDae::lost(const DaeState& state) const {
  const double distance = (state.x.head<3>() - mission_.reference.at(state.t).position).norm();
  if (distance <= mission_.lost) return "";
  std::string why = fmt::format("the flight is lost, {:.3g} m from its reference", distance);
  const Wrench hover = hover_wrench(state.t), error = hover_error(state.t, hover);
  if (error.norm() > kShort * hover.norm()) {
    return why + fmt::format("; hovering there takes {:.3g} N, and the rotors give {:.3g} N", hover.norm(), (hover + error).head<3>().norm());
  }
  const auto unstable = [](const char* what, const Gains& g, double lag) {
    return fmt::format("; with a lag of {:g} s its {} gains {:g}, {:g}, {:g} make an unstable loop", lag, what, g.proportional, g.integral,
                       g.derivative);
  };
  const PoseControllerOptions& controller = mission_.controller;
  const double lag = controller.actuator_lag - controller.lead;
  if (!is_stable(controller.force, mission_.mass(), lag)) return why + unstable("force", controller.force, lag);
  if (!is_stable(controller.torque, mission_.vehicle.inertia.maxCoeff(), lag)) return why + unstable("torque", controller.torque, lag);
  return why;
}

/// What holds the vehicle where it should be, body axes.
Wrench FlightDae::hover_wrench(double t) const {
  Wrench wrench;
  wrench << mission_.reference.at(t).attitude.conjugate() * Vector3d(0, 0, mission_.mass() * mission_.vehicle.gravity), Vector3d::Zero();
  return wrench;
}

/// What rotors that are left give beyond it.
Wrench FlightDae::hover_error(double t, const Wrench& wrench) const {
  const auto allocator = make_allocator_(mission_.vehicle);
  for (const Failure& failure : mission_.failures) {
    if (t >= failure.t && failure.kind == Failure::Kind::rotor) allocator->fail_rotor(failure.rotor);
  }
  return allocator->allocate(wrench, mission_.controller.period).error;
}

void FlightDae::fail(DaeState& state, const EventLog& log) const {
  for (const Failure& failure : mission_.failures) {
    const bool is_rotor = failure.kind == Failure::Kind::rotor;
    int& flag = state.mode.discrete[static_cast<std::size_t>(is_rotor ? at_.failed(failure.rotor) : at_.stuck(failure.rotor))];
    if (flag != 0 || state.t < failure.t - kSameInstant) continue;
    flag = 1;
    log({.t = state.t, .contact = fmt::format("{} {}", is_rotor ? kRotor : kServo, failure.rotor + 1), .from = 0, .to = 1});
  }
}

void FlightDae::blow(DaeState& state) const {
  const Wind& wind = mission_.wind;
  if (wind.deviation == 0) return;
  // (1.6) g <- rho g + sqrt(1 - rho^2) deviation n,   rho = exp(-T/correlation)
  const double rho = std::exp(-mission_.controller.period / wind.correlation);
  Noise noise(mission_.seed + 1, static_cast<std::uint64_t>(state.mode.discrete[Layout::kTicks]));
  auto gust = state.mode.held.segment<3>(at_.gust());
  gust = rho * gust + std::sqrt(1 - rho * rho) * wind.deviation * noise.normal3();
}

bool FlightDae::measure(const DaeState& state, PoseMeasurement& measurement) const {
  const Sensors& sensors = mission_.sensors;
  const int k = state.mode.discrete[Layout::kTicks];
  Noise noise(mission_.seed, static_cast<std::uint64_t>(k));
  const Quaterniond q(state.x[kAttitude], state.x[kAttitude + 1], state.x[kAttitude + 2], state.x[kAttitude + 3]);
  measurement.position = state.x.head<3>() + sensors.position_noise * noise.normal3();
  measurement.attitude = q * rotation_of(sensors.attitude_noise * noise.normal3());
  if (k > 0) return sensors.drop_out == 0 || noise.uniform() > sensors.drop_out;
  measurement.velocity = state.x.segment<3>(kVelocity);  // an observer starts from what is known
  measurement.angular_velocity = state.x.segment<3>(kRate);
  return true;
}

void FlightDae::tick(DaeState& state, Memory& memory) const {
  const int n = rotors_.size(), ticks = state.mode.discrete[Layout::kTicks];
  Vector& held = state.mode.held;
  Vector angles = held.segment(at_.allocated() + n, n);
  if (memory.next_tick != ticks) {  // the first, or one that does not follow the last
    memory.allocator = memory.make_allocator(memory.vehicle);
    memory.allocator->reset(angles);
    std::ranges::fill(memory.knows, false);
  }
  memory.next_tick = ticks + 1;
  for (std::size_t k = 0; k < memory.knows.size(); ++k) {
    const Failure& failure = mission_.failures[k];
    if (memory.knows[k] || !(state.t >= failure.t + failure.detection)) continue;
    memory.knows[k] = true;
    if (failure.kind == Failure::Kind::rotor) {
      memory.allocator->fail_rotor(failure.rotor);
    } else {
      angles[failure.rotor] = state.x[kRotors + n + failure.rotor];  // where it stands is measured
      memory.allocator->reset(angles);
      memory.allocator->stick_servo(failure.rotor);
    }
  }

  PoseMeasurement measurement;
  const bool is_seen = measure(state, measurement);
  auto remembered = held.segment<PoseControllerState::kSize>(at_.controller());
  memory.controller.reset(PoseControllerState::read(remembered));
  const Wrench asked = memory.controller.tick(is_seen ? &measurement : nullptr, mission_.reference.at(state.t + mission_.controller.lead));
  const Allocation& allocation = memory.allocator->allocate(asked, mission_.controller.period);
  memory.controller.given(asked + allocation.error, allocation.status != AllocationStatus::solved);
  memory.controller.state().write(remembered);
  held.segment<6>(at_.error()) = allocation.error;
  state.mode.discrete[Layout::kStatus] = static_cast<int>(allocation.status);

  std::copy(held.data() + 2 * n, held.data() + at_.commands_size(), held.data());  // those on their way move on
  held.segment(at_.allocated(), 2 * n) << allocation.throttle, allocation.angle;
}

void FlightDae::watch_limits(DaeState& state, ConstVectorRef last_angles, const EventLog& log) const {
  const int n = rotors_.size();
  std::vector<int>& flags = state.mode.discrete;
  const auto watch = [&](int place, const char* what, int i, double value, double lower, double upper, double margin) {
    const int now = value >= upper - margin ? 1 : value <= lower + margin ? -1 : 0;
    int& before = flags[static_cast<std::size_t>(place)];
    if (before != now) log({.t = state.t, .contact = fmt::format("{} {}", what, i + 1), .from = before, .to = now});
    before = now;
    flags[Layout::kViolations] += value > upper + margin || value < lower - margin;
  };
  for (int i = 0; i < n; ++i) {
    const Rotor& rotor = mission_.vehicle.rotors[static_cast<std::size_t>(i)];
    const double u = state.mode.held[at_.allocated() + i], a = state.mode.held[at_.allocated() + n + i];
    watch(at_.throttle_limit(i), kThrottle, i, u, rotor.throttle_lower, rotor.throttle_upper, kAtLimit);
    if (flags[static_cast<std::size_t>(at_.stuck(i))] != 0) continue;  // what is asked of it does not count
    const double rate = (a - last_angles[i]) / mission_.controller.period, most = rotor.angle_rate_limit;
    watch(at_.rate_limit(i), kArmRate, i, rate, -most, most, kAtLimit * most);
    flags[Layout::kViolations] += a < rotor.angle_lower - kAtLimit || a > rotor.angle_upper + kAtLimit;
  }
}

void FlightDae::last_tick(const DaeState& state, FlightTick& out) const {
  const int n = rotors_.size();
  const Vector& held = state.mode.held;
  const PoseControllerState controller = PoseControllerState::read(held.segment<PoseControllerState::kSize>(at_.controller()));
  out.reference = mission_.reference.at(state.t);
  const Quaterniond q(state.x[kAttitude], state.x[kAttitude + 1], state.x[kAttitude + 2], state.x[kAttitude + 3]);
  out.position_error = (state.x.head<3>() - out.reference.position).norm();
  out.angle_error = rotation_vector(out.reference.attitude.conjugate() * q).norm();
  out.error = held.segment<6>(at_.error());
  out.asked = controller.asked - out.error;
  out.status = static_cast<AllocationStatus>(state.mode.discrete[Layout::kStatus]);
  out.throttle = held.segment(at_.allocated(), n);
  out.angle = held.segment(at_.allocated() + n, n);
  out.limits_violated = state.mode.discrete[Layout::kViolations];
}

// --- the record ------------------------------------------------------------------------------------------------------------------------

int FlightDae::num_outputs() const { return 7 + 2 + 3 + 12 + 3 * rotors_.size(); }

void FlightDae::outputs(const DaeState& state, Workspace&, VectorRef values) const {
  const int n = rotors_.size();
  FlightTick last;
  last_tick(state, last);
  const Quaterniond& q = last.reference.attitude;
  values << last.reference.position, q.w(), q.vec(), last.position_error, last.angle_error, wind(state.mode), last.asked, last.error,
      state.mode.held.head(2 * n), state.xdot.tail(n);
}

std::string FlightDae::output_name(int i) const {
  static const char* const names[] = {"x_ref",   "y_ref",    "z_ref",    "qw_ref",   "qx_ref",   "qy_ref",   "qz_ref",   "position_error",
                                      "angle_error", "wind_x",   "wind_y",   "wind_z",   "Fx_asked", "Fy_asked", "Fz_asked", "Mx_asked",
                                      "My_asked", "Mz_asked", "Fx_error", "Fy_error", "Fz_error", "Mx_error", "My_error", "Mz_error"};
  constexpr int kNamed = std::size(names);
  if (i < kNamed) return names[i];
  const int n = rotors_.size(), k = i - kNamed;
  const std::string number = std::to_string(k % n + 1);
  return k < n ? "u" + number + "_command" : k < 2 * n ? "a" + number + "_command" : "a" + number + "_rate";
}

}  // namespace tenon::flight
