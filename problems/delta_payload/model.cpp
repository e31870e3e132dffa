#include "tenon/problems/delta_payload/model.hpp"

#include <limits>
#include <stdexcept>

#include "tenon/core/automatic_function.hpp"

namespace tenon::delta_payload {

namespace {

using delta::Vector3;

/// The robot's equations are not templates: their derivatives are central differences, good to some nine digits.
class PayloadDae final : public Dae {
 public:
  explicit PayloadDae(const delta::Robot& bare) : robot_(bare), bare_(bare) {}

  int num_states() const override { return kStates; }
  int num_algebraics() const override { return 0; }
  int num_inputs() const override { return delta::kArms; }
  void initial_state(DaeState&) const override {}

  void residual(const DaeMode&, const DaePoint& at, Workspace&, VectorRef F) const override { F = at.xdot - rates(at.x, at.u); }

  void jacobian(const DaeMode&, const DaePoint& at, double alpha, Workspace&, std::span<double> values) const override {
    State x = at.x;
    differentiate(
        x, [&] { return rates(x, at.u); }, values);
    for (int c = 0; c < kStates; ++c) values[std::size_t((kStates + 1) * c)] += alpha;
  }
  void input_jacobian(const DaeMode&, const DaePoint& at, Workspace&, std::span<double> values) const override {
    Vector3 u = at.u;
    differentiate(
        u, [&] { return rates(at.x, u); }, values);
  }

  bool has_derivatives() const override { return true; }
  void derivatives(const DaeMode&, double, ConstVectorRef x, ConstVectorRef u, Workspace&, VectorRef xdot, VectorRef) const override {
    xdot = rates(x, u);
  }

  std::string name() const override { return "delta-payload"; }
  std::string state_name(int i) const override { return kStateNames[static_cast<std::size_t>(i)]; }
  std::string input_name(int i) const override { return "torque" + std::to_string(i + 1); }

 private:
  /// Payload and damping enter the constants linearly, a third of the payload at each arm's tip.
  delta::ArmConstants constants_with(double payload, double damping) const {
    delta::ArmConstants k = bare_;
    const double l1 = robot_.proximal_length, l2 = robot_.distal_length, tip = payload / delta::kArms;
    k.a += l1 * l1 * tip, k.b += l1 * l2 * tip, k.i += l2 * l2 * tip, k.k += l2 * tip, k.moment += l1 * tip;
    k.damping[0] = damping;
    return k;
  }

  /// -df/dz, column by column, f to be evaluated at what stands in z.
  template <int N, class F>
  static void differentiate(Eigen::Matrix<double, N, 1>& z, F&& f, std::span<double> values) {
    constexpr double kStep = 1e-5;  // rad, rad/s, kg, N m s, N m
    for (int c = 0; c < N; ++c) {
      const double here = z[c];
      z[c] = here + kStep;
      const State above = f();
      z[c] = here - kStep;
      const State below = f();
      z[c] = here;
      Eigen::Map<State>(values.data() + kStates * c) = (below - above) / (2 * kStep);
    }
  }

  State rates(ConstVectorRef x, ConstVectorRef u) const {
    State out = State::Zero();
    const Vector3 y_rate = x.segment<3>(kRate);
    const delta::Forward forward = delta::forward_kinematics(robot_, x.segment<3>(kAngle));
    if (!forward.ok()) return State::Constant(std::numeric_limits<double>::quiet_NaN());
    const delta::Motion motion(robot_, forward.at);
    const Vector3 velocity = motion.jacobian * y_rate;
    const Vector3 acceleration =
        delta::wrist_acceleration(robot_, constants_with(x[kPayload], x[kDamping]), forward.at, velocity, u, Vector3::Zero());
    const Vector3 bias = delta::motion_bias(robot_, forward.at, motion, motion.rates(y_rate)).wrist;
    out.segment<3>(kAngle) = y_rate;
    out.segment<3>(kRate) = motion.motors(acceleration - bias);
    return out;
  }

  delta::Robot robot_;  // of it only the geometry counts
  delta::ArmConstants bare_;
};

}  // namespace

Prior prior(const Parameters& parameters, const Eigen::Vector2d& payload, const Eigen::Vector2d& damping) {
  const delta::Inverse start = delta::inverse_kinematics(parameters.robot, parameters.centre);
  if (!start.ok()) throw std::invalid_argument("robot " + parameters.robot.name + " does not reach the centre");
  Prior prior;
  prior.mean << start.q[0], start.q[3], start.q[6], 0, 0, 0, payload[0], damping[0];
  prior.deviation << Vector3::Constant(5e-3), Vector3::Constant(0.01), payload[1], damping[1];  // rad: about a millimetre; rad/s: at rest
  return prior;
}

delta::Robot robot_with(const Parameters& parameters, double payload, double damping) {
  delta::Robot robot = parameters.robot;
  robot.payload = payload;
  robot.damping[0] = damping;
  return robot;
}

EstimationProblem estimation_problem(const Parameters& parameters, const Prior& prior, int window) {
  EstimationProblem problem(std::make_shared<PayloadDae>(robot_with(parameters, 0, 0)),
                            automatic_function<kStates + delta::kArms, delta::kArms>(
                                [](const auto& z, auto& y) {
                                  y = {z[kAngle], z[kAngle + 1], z[kAngle + 2]};
                                },
                                {"q11", "q21", "q31"}));
  problem.name = "delta payload";
  problem.noise.setConstant(parameters.noise);
  problem.mean = prior.mean;
  problem.deviation = prior.deviation;
  problem.is_positive[kPayload] = problem.is_positive[kDamping] = true;
  problem.ripple.setConstant(parameters.torque_ripple);
  problem.window = window;
  problem.longest_step = parameters.period;
  problem.solve.tolerance = 1e-6;
  problem.solve.max_iterations = 5;  // the next window goes on from there
  return problem;
}

}  // namespace tenon::delta_payload
