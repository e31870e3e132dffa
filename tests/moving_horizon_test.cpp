// The moving horizon: Kalman's filter where the problem is linear, a posterior that is right about its own errors where it is not.
#include "tenon/mpc/moving_horizon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/automatic_function.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/random.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon {
namespace {

constexpr double kPeriod = 0.05;

std::unique_ptr<Solver> newton(const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); }

/// A cart that is pushed by u and by a constant that nobody knows.
struct Cart {
  static constexpr int kStates = 3, kAlgebraics = 0, kInputs = 1;
  template <class T>
  void equations(const DaeMode&, const std::array<T, 3>& x, const std::array<T, 0>&, const std::array<T, 1>& u, std::array<T, 3>& xdot,
                 std::array<T, 0>&) const {
    xdot = {x[1], x[2] + u[0], T(0)};
  }
};

EstimationProblem cart(int window) {
  EstimationProblem problem(std::make_shared<AutomaticDae<Cart>>(Cart{}), automatic_function<4, 1>([](const auto& z, auto& y) { y[0] = z[0]; }));
  problem.noise << 0.01;
  problem.mean << 0.1, -0.2, 0.3;
  problem.deviation << 1, 0.5, 2;
  problem.drift << 0, 0.02, 0;
  problem.window = window;
  return problem;
}

/// A pendulum that swings under a known torque: what it weighs against how long it is, and its friction, are not known.
struct Pendulum {
  static constexpr int kStates = 4, kAlgebraics = 0, kInputs = 1;
  template <class T>
  void equations(const DaeMode&, const std::array<T, 4>& x, const std::array<T, 0>&, const std::array<T, 1>& u, std::array<T, 4>& xdot,
                 std::array<T, 0>&) const {
    xdot = {x[1], u[0] - x[2] * sin(x[0]) - x[3] * x[1], T(0), T(0)};
  }
  std::string state_name(int i) const { return std::array{"angle", "rate", "stiffness", "friction"}[std::size_t(i)]; }
};

EstimationProblem pendulum(int window = 10) {
  EstimationProblem problem(std::make_shared<AutomaticDae<Pendulum>>(Pendulum{}),
                            automatic_function<5, 1>([](const auto& z, auto& y) { y[0] = z[0]; }, {"angle"}));
  problem.name = "pendulum";
  problem.noise << 0.01;
  problem.mean << 0, 0, 10, 0.5;
  problem.deviation << 0.1, 0.1, 2, 0.2;
  problem.drift << 0, 0.02, 0, 0;
  problem.window = window;
  problem.longest_step = kPeriod / 2;
  return problem;
}

/// A world of the problem: a true state drawn from the prior, drifting, and measured.
class World {
 public:
  World(const EstimationProblem& problem, std::uint64_t seed)
      : problem_(problem), random_(seed), transition_(*problem.dae, problem.mode, problem.longest_step), x(problem.mean) {
    for (int i = 0; i < x.size(); ++i) x[i] += problem.deviation[i] * random_.normal();
  }
  void advance(const Vector& u) {
    transition_.advance(x, u, kPeriod);
    x = transition_.state;
    for (int i = 0; i < x.size(); ++i) x[i] += problem_.drift[i] * std::sqrt(kPeriod) * random_.normal();
  }
  Vector measured(const Vector& u) {
    Vector z(x.size() + u.size()), y(problem_.noise.size());
    z << x, u;
    problem_.measured->values(z, y);
    for (int i = 0; i < y.size(); ++i) y[i] += problem_.noise[i] * random_.normal();
    return y;
  }

 private:
  const EstimationProblem& problem_;
  Random random_;
  StateTransition transition_;

 public:
  Vector x;
};

Vector push(int k, double size) { return Vector::Constant(1, size * std::sin(0.15 * k)); }

/// `steps` updates in this world; each is seen by `look` with the true state.
template <class Look>
void run(Estimator& estimator, World& world, int steps, double size, Look&& look) {
  estimator.reset();
  Vector held = Vector::Zero(1);
  for (int k = 0; k < steps; ++k) {
    if (k > 0) world.advance(held);
    estimator.update(k * kPeriod, world.measured(held), held);
    look(k);
    held = push(k, size);
  }
}

Vector mean_of(const Estimator& estimator) {
  Vector mean(estimator.num_estimates());
  estimator.mean(mean);
  return mean;
}
Eigen::MatrixXd covariance_of(const Estimator& estimator) {
  Eigen::MatrixXd covariance(estimator.num_estimates(), estimator.num_estimates());
  estimator.covariance(covariance);
  return covariance;
}

TEST(MovingHorizon, IsKalmansFilterWhereTheProblemIsLinearWhateverTheWindow) {
  for (const int window : {1, 4, 12}) {
    const EstimationProblem problem = cart(window);
    MovingHorizon horizon(problem, &newton);
    World world(problem, 7);
    Vector m = problem.mean;
    Eigen::MatrixXd p = problem.deviation.cwiseAbs2().asDiagonal();
    Eigen::Matrix3d a;
    a << 1, kPeriod, kPeriod * kPeriod / 2, 0, 1, kPeriod, 0, 0, 1;
    horizon.reset();
    Vector held = Vector::Zero(1);
    for (int k = 0; k < 40; ++k) {
      if (k > 0) {
        world.advance(held);
        m = a * m + held[0] * Eigen::Vector3d(kPeriod * kPeriod / 2, kPeriod, 0);
        p = a * p * a.transpose();
        p.diagonal() += kPeriod * problem.drift.cwiseAbs2();
      }
      const Vector y = world.measured(held);
      const Eigen::Vector3d gain = p.col(0) / (p(0, 0) + problem.noise[0] * problem.noise[0]);
      m += gain * (y[0] - m[0]);
      p -= (gain * p.row(0)).eval();
      horizon.update(k * kPeriod, y, held);
      EXPECT_EQ(horizon.result().status, Status::solved);
      EXPECT_LE((mean_of(horizon) - m).cwiseQuotient(problem.deviation).norm(), 1e-8) << "window " << window << ", update " << k;
      EXPECT_LE((covariance_of(horizon) - p).norm(), 1e-8 * problem.deviation.squaredNorm()) << "window " << window << ", update " << k;
      held = push(k, 1);
    }
  }
}

// The end of the recursion is the end of the window's solution: what is said of its spread is said of this point.
TEST(MovingHorizon, ItsCovarianceIsThatOfTheWindowsSolution) {
  const EstimationProblem problem = pendulum();
  MovingHorizon horizon(problem, &newton);
  World world(problem, 3);
  run(horizon, world, 40, 3, [&](int k) {
    const Vector end = horizon.window().belief(horizon.solution().x).mean.cwiseProduct(problem.deviation);
    EXPECT_LE((end - mean_of(horizon)).cwiseQuotient(problem.deviation).norm(), 1e-6) << "update " << k;
  });
}

}  // namespace
}  // namespace tenon
