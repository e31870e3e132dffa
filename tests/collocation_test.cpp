// Direct collocation: derivatives, order, replay by another integrator, and the same answer on every kind of linear algebra.
#include <gtest/gtest.h>

#include <random>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/mpc/planner.hpp"
#include "tenon/problems/optimal_control/ocp_scene.hpp"
#include "tenon/solvers/make_integrator.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"
#include "tenon/tests/allocation_counter.hpp"

namespace tenon {
namespace {

bool is_available(const std::string& name) {
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.name == name) return solver.available;
  }
  for (const IntegratorDescription& integrator : list_integrators()) {
    if (integrator.name == name) return integrator.available;
  }
  return false;
}

SolverFactory factory_of(const std::string& name) {
  return [name](const Nlp& problem, const Options& options) { return make_solver(name, problem, options); };
}

/// A scene with its contact treated in one of the ways it knows.
struct Case {
  std::string scene, contact;

  OcpScene load() const {
    std::vector<std::string> overrides;
    if (!contact.empty()) overrides.push_back("contact=" + contact);
    if (contact == "baumgarte") overrides.push_back("epsilon=2e-5");  // tighter, the sources' pair often ends infeasible
    return load_ocp_scene(scene, overrides);
  }
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.scene << c.contact; }
};

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const std::string& scene : builtin_ocp_scenes()) cases.push_back({scene, ""});
  for (const char* contact : {"phases", "baumgarte", "law"}) cases.push_back({"push-and-slide", contact});
  return cases;
}

class EveryScene : public testing::TestWithParam<Case> {};

TEST_P(EveryScene, ObeysTheDerivativeLawAtRandomPoints) {
  OcpScene scene = GetParam().load();
  for (OcpPhase& phase : scene.ocp.phases) phase.intervals = 3;  // every kind of stage, and few of them
  std::mt19937 random(1981);
  std::normal_distribution<double> normal;
  for (const int points : {1, 2, 3}) {
    const Collocation program(scene.ocp, points);
    const int n = program.num_variables(), m = program.num_constraints();
    Vector start(n);
    program.initial_point(start);
    const Vector x = start + Vector::NullaryExpr(n, [&](auto) { return 0.1 * normal(random); });
    const Vector lambda = Vector::NullaryExpr(m, [&](auto) { return normal(random); });
    // The pad of the law bends within 2 mm: third derivatives spoil differences there.
    const DerivativeReport report = check_derivatives(program, x, normal(random), lambda, GetParam().contact == "law" ? 1e-4 : 1e-6);
    ASSERT_TRUE(report.finite);
    for (const DerivativeError& e : report.worst)
      ADD_FAILURE() << points << " points, " << e.what << " of " << e.row << " by " << e.variable << ": " << e.analytic
                    << ", by differences " << e.difference;
  }
}

/// Of a state that the plan's inputs lead to, phase by phase.
Vector replayed(const Ocp& ocp, const Plan& plan, const std::string& integrator_name) {
  const auto integrator = make_integrator(integrator_name, *ocp.dae, {.rtol = 1e-11, .atol = 1e-13});
  DaeState state = plan.at(0, 0);
  for (std::size_t k = 0; k < plan.intervals().size(); ++k) {
    const PlanInterval& interval = plan.intervals()[k];
    state.t = interval.t, state.u = interval.u, state.mode = plan.modes()[static_cast<std::size_t>(interval.phase)];
    const IntegrationResult result = integrator->advance(state, interval.t + interval.length);
    EXPECT_EQ(result.status, IntegrationStatus::reached) << result.explanation;
    const bool leaves_phase = k + 1 < plan.intervals().size() && plan.intervals()[k + 1].phase != interval.phase;
    if (const auto& link = ocp.phases[static_cast<std::size_t>(interval.phase)].link; leaves_phase && link) {
      const Vector before = state.x;
      link->values(before, state.x);
    }
  }
  return state.x;
}

TEST_P(EveryScene, IsPlannedAndReplayedWithinItsMeshError) {
  // What another integrator finds at the end may be this much more than what the mesh says of it: the estimate leaves out steps of higher
  // order, and where friction stops a block within a step they count.
  constexpr double kFactor = 3, kReplay = 2e-9;
  const OcpScene scene = GetParam().load();
  const PlannerOutcome outcome = make_plan(scene.ocp, factory_of("newton-kkt"),
                                           {.points = scene.points, .tolerance = scene.tolerance, .refinements = scene.refinements});
  ASSERT_EQ(outcome.result.status, Status::solved);
  EXPECT_LE(outcome.error.worst, scene.tolerance);
  const Vector end = outcome.plan.at(outcome.plan.duration()).x;
  for (const std::string integrator : {"dop853", "ida"}) {
    if (!is_available(integrator)) continue;
    const Vector error = (replayed(scene.ocp, outcome.plan, integrator) - end).cwiseAbs();
    EXPECT_LE(error.maxCoeff(), kFactor * outcome.error.end.maxCoeff() + kReplay) << integrator;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(every_case()), [](const auto& p) {
  std::string name = p.param.scene + "_" + (p.param.contact.empty() ? "as_it_is" : p.param.contact);
  std::ranges::replace(name, '-', '_');
  return name;
});

/// A ball that touches a plane, in contact: h = x, h'' + 20 h' + 100 h + 1e4 h^3 = 0 by lambda.
struct TouchingBall {
  static constexpr int kStates = 2, kAlgebraics = 1, kInputs = 0;
  template <class T>
  void equations(const DaeMode&, const std::array<T, 2>& x, const std::array<T, 1>& y, const std::array<T, 0>&, std::array<T, 2>& xdot,
                 std::array<T, 1>& g) const {
    const T acceleration = y[0] - 9.81;
    xdot = {x[1], acceleration};
    g[0] = acceleration + 20 * x[1] + 100 * x[0] + 1e4 * x[0] * x[0] * x[0];
  }
};

/// |x(T) - exact| of a phase without a choice, on so many intervals.
double end_error(const Ocp& like, int points, int intervals, const Vector& exact) {
  Ocp ocp = like;
  ocp.phases.front().intervals = intervals;
  const Collocation program(ocp, points);
  Point point(program.num_variables(), program.num_constraints());
  program.initial_point(point.x);
  const Result result = make_solver("newton-kkt", program, {.tolerance = 1e-12})->solve(point);
  EXPECT_TRUE(succeeded(result.status)) << to_string(result.status);
  const Plan plan = program.plan(point.x);
  return (plan.at(plan.duration()).x - exact).cwiseAbs().maxCoeff();
}

/// From `start` for `duration`, without any cost.
Ocp free_motion(std::shared_ptr<const Dae> dae, const Vector& start, double duration) {
  OcpPhase phase(*dae);
  phase.name = "motion";
  phase.duration = duration;
  phase.start.lower = phase.start.upper = start;
  phase.u.lower.setZero(), phase.u.upper.setZero();
  phase.guess = [start](double, VectorRef x, VectorRef, VectorRef) { x = start; };
  return {.name = "motion", .dae = std::move(dae), .phases = {phase}};
}

void expect_order(const Ocp& ocp, const std::array<int, 3>& intervals) {
  Ocp fine = ocp;
  fine.phases.front().intervals = 100;
  const Collocation reference(fine, 4);
  Point point(reference.num_variables(), reference.num_constraints());
  reference.initial_point(point.x);
  ASSERT_TRUE(succeeded(make_solver("newton-kkt", reference, {.tolerance = 1e-13})->solve(point).status));
  const Plan plan = reference.plan(point.x);
  const Vector exact = plan.at(plan.duration()).x;
  for (int s = 1; s <= 3; ++s) {
    const int n = intervals[static_cast<std::size_t>(s - 1)];
    const double coarse = end_error(ocp, s, n, exact), halved = end_error(ocp, s, 2 * n, exact);
    EXPECT_NEAR(std::log2(coarse / halved), 2 * s - 1, 0.35) << s << " points: " << coarse << ", " << halved;
  }
}

TEST(Order, OfThePendulumInRedundantCoordinatesIsThatOfTheMethod) {
  const OcpScene scene = load_ocp_scene("pendulum-cartesian");
  expect_order(free_motion(scene.ocp.dae, Eigen::Vector4d(0.8, -0.6, 0, 0), 1), {400, 40, 20});
}

TEST(Order, OfAContactPhaseIsThatOfTheMethod) {
  expect_order(free_motion(std::make_shared<AutomaticDae<TouchingBall>>(), Eigen::Vector2d(0, -1), 0.2), {200, 20, 10});
}

TEST(Radau, HasThePublishedAbscissae) {  // [HW96, table IV.5.5, 5.6]
  EXPECT_NEAR(radau(2).abscissae[1], 1.0 / 3, 1e-15);
  EXPECT_NEAR(radau(2).weights[0], 0.75, 1e-15);
  EXPECT_NEAR(radau(3).abscissae[1], (4 - std::sqrt(6.0)) / 10, 1e-15);
  EXPECT_NEAR(radau(3).abscissae[2], (4 + std::sqrt(6.0)) / 10, 1e-15);
  EXPECT_NEAR(radau(3).weights[2], 1.0 / 9, 1e-14);
  EXPECT_THROW(radau(0), std::invalid_argument);
}

TEST(Kinds, StagesAndSparseAgree) {
  for (const char* name : {"pendulum", "bouncing-ball-catch"}) {
    const OcpScene scene = load_ocp_scene(name);
    const Collocation program(scene.ocp, 2);
    Point staged(program.num_variables(), program.num_constraints());
    program.initial_point(staged.x);
    Point sparse = staged;
    const Result a = NewtonKkt<Nlp, StageKkt<>>(program, {}).solve(staged), b = NewtonKkt<Nlp, SparseKkt>(program, {}).solve(sparse);
    EXPECT_EQ(a.status, Status::solved) << name;
    EXPECT_EQ(b.status, Status::solved) << name;
    EXPECT_NEAR(a.objective, b.objective, 1e-7 * std::abs(b.objective)) << name;
    EXPECT_LE((staged.x - sparse.x).cwiseAbs().maxCoeff(), 1e-5 * (1 + sparse.x.cwiseAbs().maxCoeff())) << name;
  }
}

TEST(BackEnds, NewtonKktAndIpoptAgree) {
  if (!is_available("ipopt")) GTEST_SKIP() << "without Ipopt";
  for (const char* name : {"cart-pole", "pendulum", "pendulum-cartesian", "bouncing-ball-catch"}) {
    const OcpScene scene = load_ocp_scene(name);
    const Collocation program(scene.ocp, scene.points);
    Point ours(program.num_variables(), program.num_constraints());
    program.initial_point(ours.x);
    Point theirs = ours;
    const Result a = make_solver("newton-kkt", program)->solve(ours), b = make_solver("ipopt", program)->solve(theirs);
    EXPECT_EQ(a.status, Status::solved) << name;
    EXPECT_EQ(b.status, Status::solved) << name;
    EXPECT_NEAR(a.objective, b.objective, 1e-6 * std::abs(b.objective)) << name;
    EXPECT_LE((ours.x - theirs.x).cwiseAbs().maxCoeff(), 1e-4 * (1 + theirs.x.cwiseAbs().maxCoeff())) << name;
  }
}

TEST(BackEnds, OnesAnswerIsTheOthersToo) {  // with contacts there are many local answers: from one of them the other stays there
  if (!is_available("ipopt")) GTEST_SKIP() << "without Ipopt";
  const OcpScene scene = load_ocp_scene("push-and-slide");
  const Collocation program(scene.ocp, scene.points);
  Point point(program.num_variables(), program.num_constraints());
  program.initial_point(point.x);
  const Result ours = make_solver("newton-kkt", program)->solve(point);
  ASSERT_EQ(ours.status, Status::solved);
  const Vector before = point.x;
  const Result theirs = make_solver("ipopt", program, {.warm_start = true})->solve(point);
  EXPECT_EQ(theirs.status, Status::solved);
  EXPECT_NEAR(theirs.objective, ours.objective, 1e-5 * ours.objective);
  EXPECT_LE((point.x - before).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(CartPole, ReachesTheOptimumOfTheShootingProgramAsTheMeshGetsFiner) {
  // Both hold the force on 100 intervals; the Runge-Kutta steps of that program are what is left between them: 1e-4.
  const OcpScene scene = load_ocp_scene("cart-pole");
  const Collocation program(scene.ocp, 3);
  Point point(program.num_variables(), program.num_constraints());
  program.initial_point(point.x);
  EXPECT_NEAR(make_solver("newton-kkt", program)->solve(point).objective, 11181.3177, 1e-4 * 11181.3177);
}

TEST(Evaluations, AllocateNothing) {
  const OcpScene scene = load_ocp_scene("bouncing-ball-catch");
  const Collocation program(scene.ocp, 3);
  Vector x(program.num_variables()), gradient = x, rows(program.num_constraints());
  program.initial_point(x);
  const Vector lambda = Vector::Ones(rows.size());
  std::vector<double> jacobian(static_cast<std::size_t>(program.jacobian_pattern().nonzeros()));
  std::vector<double> hessian(static_cast<std::size_t>(program.hessian_pattern().nonzeros()));
  Nlp::Workspace workspace = program.make_workspace();
  const AllocationCounter counter;
  program.prepare(x, workspace);
  program.objective(x, workspace);
  program.gradient(x, workspace, gradient);
  program.constraints(x, workspace, rows);
  program.jacobian(x, workspace, jacobian);
  program.hessian(x, 1, lambda, workspace, hessian);
  EXPECT_EQ(counter.count(), 0);
}

TEST(Plans, FollowTheirPolynomialsAndStartASecondSolveWhereTheyEnd) {
  const OcpScene scene = load_ocp_scene("pendulum");
  const Collocation program(scene.ocp, 3);
  Point point(program.num_variables(), program.num_constraints());
  program.initial_point(point.x);
  make_solver("newton-kkt", program)->solve(point);
  const Plan plan = program.plan(point.x);
  Vector again(point.x.size());
  program.point_of(plan, again);
  EXPECT_LE((again - point.x).cwiseAbs().maxCoeff(), 1e-12);
  const double t = 0.437, step = 1e-6;
  const Vector difference = (plan.at(t + step).x - plan.at(t - step).x) / (2 * step);
  EXPECT_LE((plan.at(t).xdot - difference).cwiseAbs().maxCoeff(), 1e-6 * (1 + difference.cwiseAbs().maxCoeff()));
}

TEST(Gap, NoForceActsAtADistanceAndNothingGoesThrough) {
  const OcpScene scene = Case{"push-and-slide", "complementarity"}.load();
  const PlannerOutcome outcome = make_plan(scene.ocp, factory_of("newton-kkt"), {.points = scene.points, .tolerance = scene.tolerance});
  ASSERT_EQ(outcome.result.status, Status::solved);
  const double epsilon = scene.ocp.phases.front().contact->epsilon;
  double impulse = 0;
  for (const PlanInterval& interval : outcome.plan.intervals()) {
    const auto gap = [&](Eigen::Index i) { return interval.x(1, i) - interval.x(0, i); };
    for (Eigen::Index i = 0; i < interval.x.cols(); ++i) EXPECT_GE(gap(i), -1e-8);
    EXPECT_LE(interval.u[1] * gap(0), epsilon + 1e-8);
    EXPECT_LE(interval.u[1] * gap(interval.x.cols() - 1), epsilon + 1e-8);
    impulse += interval.u[1] * interval.length;
  }
  EXPECT_GT(impulse, 0.3 * 0.1) << "the block went nowhere";
}

TEST(Ocps, ThatMakeNoSenseAreRefusedByName) {
  OcpScene scene = load_ocp_scene("pendulum");
  scene.ocp.phases.front().u.lower[0] = 100;
  try {
    Collocation(scene.ocp, 3);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("phase 'swing-up': bounds of u"), std::string::npos) << error.what();
  }
  EXPECT_THROW(Collocation(load_ocp_scene("pendulum").ocp, 3, Mesh{{0, 0.5, 0.5, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
