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

std::unique_ptr<Solver> newton(const Nlp& problem, const Options& options) {
  return make_solver("newton-kkt", problem, options);
}

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
  EstimationProblem problem(std::make_shared<AutomaticDae<Cart>>(Cart{}),
                            automatic_function<4, 1>([](const auto& z, auto& y) { y[0] = z[0]; }));
  problem.noise << 0.01;
  problem.mean << 0.1, -0.2, 0.3;
  problem.deviation << 1, 0.5, 2;
  problem.ripple << 0.1;
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
      : x(problem.mean), problem_(problem), random_(seed), transition_(*problem.dae, problem.mode, problem.longest_step) {
    for (int i = 0; i < x.size(); ++i) x[i] += problem.deviation[i] * random_.normal();
  }
  Vector x;

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
};

Vector push(int k, double size) {
  return Vector::Constant(1, size * std::sin(0.15 * k));
}

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
    const Eigen::Vector3d b(kPeriod * kPeriod / 2, kPeriod, 0);
    horizon.reset();
    Vector held = Vector::Zero(1);
    for (int k = 0; k < 40; ++k) {
      if (k > 0) {
        world.advance(held);
        m = a * m + b * held[0];
        p = a * p * a.transpose() + problem.ripple[0] * problem.ripple[0] * b * b.transpose();
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

/// (x - mean)' P^-1 (x - mean), what is positive by its logarithm.
double normalised_error(const EstimationProblem& problem, const Estimator& estimator, const Vector& x) {
  const Vector mean = mean_of(estimator);
  Vector error = x - mean;
  for (int i = 0; i < error.size(); ++i) {
    if (problem.is_positive[std::size_t(i)]) error[i] = mean[i] * std::log(x[i] / mean[i]);
  }
  const Eigen::MatrixXd covariance = covariance_of(estimator).selfadjointView<Eigen::Lower>();
  return error.dot(covariance.llt().solve(error));
}

// Of 100 worlds drawn from the prior: a mean of chi squared with 4 degrees of freedom has the deviation sqrt(8/100) = 0.28.
TEST(MovingHorizon, ItsErrorsAreAsLargeAsItSays) {
  const EstimationProblem problem = pendulum();
  MovingHorizon horizon(problem, &newton);
  double sum = 0;
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    World world(problem, seed);
    run(horizon, world, 100, 3, [](int) {});
    const double error = normalised_error(problem, horizon, world.x);
    sum += error;
    outside += error > 13.28 ? 1 : 0;  // 1 % of chi squared with 4 degrees of freedom
    EXPECT_LT(covariance_of(horizon)(2, 2), 0.3 * 0.3) << "world " << seed << ": the stiffness was 2 before";
    EXPECT_LT(covariance_of(horizon)(3, 3), 0.1 * 0.1) << "world " << seed << ": the friction was 0.2 before";
  }
  EXPECT_NEAR(sum / 100, 4, 3 * 0.28);
  EXPECT_LE(outside, 5);
}

TEST(MovingHorizon, WhatNothingExcitesKeepsItsPrior) {
  EstimationProblem problem = pendulum();
  problem.deviation[0] = problem.deviation[1] = 1e-6;  // it hangs at rest
  problem.drift.setZero();
  MovingHorizon horizon(problem, &newton);
  for (int k = 0; k < 30; ++k) horizon.update(k * kPeriod, Vector::Zero(1), Vector::Zero(1));
  EXPECT_NEAR(mean_of(horizon)[2], problem.mean[2], 1e-9);
  EXPECT_NEAR(mean_of(horizon)[3], problem.mean[3], 1e-9);
  EXPECT_NEAR(std::sqrt(covariance_of(horizon)(2, 2)), problem.deviation[2], 1e-6);
  EXPECT_NEAR(std::sqrt(covariance_of(horizon)(3, 3)), problem.deviation[3], 1e-6);
}

// The same window, one of each kind of linear algebra and another method's point of view.
TEST(MovingHorizon, EveryBackEndFindsTheSameState) {
  EstimationProblem problem = pendulum();
  problem.is_positive[2] = problem.is_positive[3] = true;
  MovingHorizon horizon(problem, &newton);
  World world(problem, 5);
  world.x = problem.mean + Vector(Eigen::Vector4d(0.05, 0.1, 1.5, 0.1));
  run(horizon, world, 25, 3, [](int) {});
  for (const SolverDescription& solver : list_solvers()) {
    if (!solver.available || solver.name.starts_with("nlopt")) continue;
    Point point(horizon.window().num_variables(), horizon.window().num_constraints());
    horizon.window().initial_point(point.x);
    const Result result = make_solver(solver.name, horizon.window())->solve(point);
    EXPECT_TRUE(succeeded(result.status)) << solver.name;
    EXPECT_LE((point.x - horizon.solution().x).lpNorm<Eigen::Infinity>(), 1e-5) << solver.name;
  }
}

TEST(MovingHorizon, TheWindowsDerivativesAreExact) {
  EstimationProblem problem = pendulum(4);
  problem.is_positive[2] = true;
  MovingHorizon horizon(problem, &newton);
  World world(problem, 2);
  run(horizon, world, 7, 3, [](int) {});
  const EstimationWindow& window = horizon.window();
  const Vector x = horizon.solution().x + 0.1 * Vector::Ones(window.num_variables());
  const DerivativeReport report = check_derivatives(window, x, 1, Vector::Zero(window.num_constraints()), 1e-6);
  EXPECT_TRUE(report.passed(1e-6)) << report.gradient_error << " " << report.jacobian_error << " " << report.hessian_error;
  EXPECT_EQ(window.variable_name(0), "angle[0]");
  EXPECT_EQ(window.variable_name(4), "drift of rate[0]");
  EXPECT_EQ(window.constraint_name(3), "prior of friction");
  EXPECT_EQ(window.constraint_name(4), "measured angle[0]");
  EXPECT_EQ(window.constraint_name(5), "angle[0]");
}

TEST(MovingHorizon, AnUpdateAllocatesNothing) {
  EstimationProblem problem = pendulum();
  problem.ripple << 0.1;
  MovingHorizon horizon(problem, &newton);
  World world(problem, 4);
  horizon.reset();
  Vector held = Vector::Zero(1), y(1);
  long count = 0;
  for (int k = 0; k < 40; ++k) {
    if (k > 0) world.advance(held);
    y = world.measured(held);
    if (k % 7 == 3) y[0] = std::numeric_limits<double>::quiet_NaN();
    const AllocationCounter counter;
    horizon.update(k * kPeriod, y, held);
    count += counter.count();
    held = push(k, 3);
  }
  EXPECT_EQ(count, 0);
}

TEST(MovingHorizon, IsTheSameBitForBitEveryTime) {
  const EstimationProblem problem = pendulum();
  MovingHorizon one(problem, &newton), two(problem, &newton);
  World first(problem, 9), second(problem, 9), other(problem, 10);
  run(two, other, 30, 3, [](int) {});  // what was before is forgotten
  run(one, first, 30, 3, [](int) {});
  run(two, second, 30, 3, [](int) {});
  EXPECT_EQ(mean_of(one), mean_of(two));
  EXPECT_EQ(covariance_of(one), covariance_of(two));
}

// An interval without a measurement is an interval of prediction.
TEST(MovingHorizon, WhatIsNotFiniteWasNotMeasured) {
  EstimationProblem problem = cart(5);
  problem.ripple.setZero();  // which is drawn for each interval, be it short or long
  MovingHorizon seeing(problem, &newton), blind(problem, &newton);
  const Vector none = Vector::Constant(1, std::numeric_limits<double>::quiet_NaN()), u = Vector::Constant(1, 0.5),
               y = Vector::Constant(1, 0.2);
  for (MovingHorizon* horizon : {&seeing, &blind}) horizon->update(0, y, Vector::Zero(1));
  blind.update(kPeriod, none, u);
  blind.update(2 * kPeriod, y, u);
  seeing.update(2 * kPeriod, y, u);
  Eigen::MatrixXd difference = covariance_of(seeing) - covariance_of(blind);
  EXPECT_LE((mean_of(seeing) - mean_of(blind)).norm(), 1e-5);
  EXPECT_LE(difference.norm(), 1e-4) << "but for the drift, which one walks in two steps";
  EXPECT_GT(covariance_of(blind)(1, 1), 0);
}

TEST(MovingHorizon, RefusesProblemsThatMakeNoSense) {
  const auto make = [](auto&& change) {
    EstimationProblem problem = pendulum();
    change(problem);
    MovingHorizon(problem, &newton);
  };
  EXPECT_MESSAGE(make([](auto& p) { p.noise.setZero(); }), std::invalid_argument,
                 "pendulum: a noise that is not positive (expected more than 0)");
  EXPECT_MESSAGE(make([](auto& p) { p.mean.resize(3); }), std::invalid_argument, "pendulum: mean has 3 entries (expected 4 finite ones)");
  EXPECT_MESSAGE(make([](auto& p) { p.window = 0; }), std::invalid_argument, "pendulum: a window of 0 intervals (expected at least 1)");
  EXPECT_MESSAGE(make([](auto& p) { p.is_positive[0] = true; }), std::invalid_argument,
                 "the mean of angle is 0.000000 (expected more than 0, as it is positive)");
}

}  // namespace
}  // namespace tenon
