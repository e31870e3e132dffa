// Integrators, on small DAEs with known solutions: accuracy follows the tolerance, events are where they are, clocks strike, a system that
// is not of index 1 is told so.
#include <gtest/gtest.h>

#include <vector>

#include "tenon/core/consistent_start.hpp"
#include "tenon/solvers/hybrid/dop853_coefficients.hpp"
#include "tenon/solvers/hybrid/dopri5_coefficients.hpp"
#include "tenon/solvers/hybrid/runge_kutta_flow.hpp"
#include "tenon/solvers/make_integrator.hpp"
#include "tenon/tests/small_daes.hpp"

namespace tenon {
namespace {

std::vector<std::string> available() {
  std::vector<std::string> names;
  for (const IntegratorDescription& d : list_integrators()) {
    if (d.available) names.push_back(d.name);
  }
  return names;
}

DaeState run(const std::string& name, const Dae& dae, double t_end, const IntegratorOptions& options) {
  DaeState state = initial_state_of(dae);
  const IntegrationResult result = make_integrator(name, dae, options)->advance(state, t_end);
  EXPECT_EQ(result.status, IntegrationStatus::reached) << name << ": " << result.explanation;
  EXPECT_EQ(state.t, t_end);
  return state;
}

template <class Method>
void expect_quadrature_conditions(int order) {
  for (int p = 1; p <= order; ++p) {  // sum b_i c_i^(p-1) = 1/p
    double sum = 0;
    for (int i = 0; i < Method::kStages; ++i) sum += Method::kA[row_of(Method::kStages) + i] * std::pow(Method::kC[i], p - 1);
    EXPECT_NEAR(sum, 1.0 / p, 1e-13) << p;
  }
  for (int i = 1; i < Method::kExtendedStages; ++i) {  // sum_j a_ij = c_i
    double sum = 0;
    for (int j = 0; j < i; ++j) sum += Method::kA[row_of(i) + j];
    EXPECT_NEAR(sum, Method::kC[i], 1e-13) << i;
  }
}

TEST(RungeKutta, TheCoefficientsMeetTheQuadratureConditionsOfTheirOrder) {
  expect_quadrature_conditions<Dop853>(8);
  expect_quadrature_conditions<Dopri5>(5);
}

TEST(RungeKutta, InsideAStepTheStateIsAsAccurateAsItsEnds) {
  const PlanarPendulum dae;
  for (const char* name : {"dop853", "dopri5"}) {
    constexpr double kRtol = 1e-8, kStep = 0.1;
    int rows = 0;
    run(name, dae, 3, {.rtol = kRtol, .atol = kRtol, .output_step = kStep, .on_output = [&](const DaeState& s) {
                         const DaeState exact = s.t > 0 ? run("dop853", dae, s.t, {.rtol = 1e-12, .atol = 1e-13}) : initial_state_of(dae);
                         EXPECT_LE((s.x - exact.x).norm(), 2e2 * kRtol) << name << " at " << s.t;
                         ++rows;
                         return true;
                       }});
    EXPECT_EQ(rows, 31);
  }
}

TEST(Integrators, FollowAStiffSolution) {
  for (const std::string& name : available()) {
    StiffRelaxation dae;
    dae.k = name == "ida" ? 1e6 : 1e2;
    const DaeState end = run(name, dae, 3, {.rtol = 1e-9, .atol = 1e-11});
    EXPECT_NEAR(end.x[0], std::cos(3.0), 1e-7) << name;
    EXPECT_NEAR(end.y[0], std::cos(3.0) * std::cos(3.0), 1e-7) << name;
  }
}

TEST(Integrators, ErrorFollowsTheTolerance) {
  const PlanarPendulum dae;
  const DaeState reference = run("dop853", dae, 10, {.rtol = 1e-13, .atol = 1e-14});
  for (const std::string& name : available()) {
    double last = 1;
    for (const double rtol : {1e-5, 1e-7, 1e-9}) {
      const double error = (run(name, dae, 10, {.rtol = rtol, .atol = rtol}).x - reference.x).norm();
      EXPECT_LT(error, 0.2 * last) << name << " at " << rtol;
      EXPECT_LT(error, 2e3 * rtol) << name << " at " << rtol;
      last = error;
    }
  }
}

TEST(Integrators, APendulumAsAConstraintKeepsItsEnergy) {
  const PlanarPendulum dae;
  const double energy = PlanarPendulum::energy(initial_state_of(dae).x), swing = 1 + energy;
  const DaeState end = run("dop853", dae, 10, {.rtol = 1e-10, .atol = 1e-12});
  EXPECT_NEAR(PlanarPendulum::energy(end.x), energy, 1e-8 * swing);
}

TEST(Integrators, BouncesComeAtTheirTimes) {
  for (const std::string& name : available()) {
    const JumpingBall dae;
    std::vector<DaeEvent> events;
    run(name, dae, 1.2, {.rtol = 1e-11, .atol = 1e-13, .on_event = [&](const DaeEvent& event) { events.push_back(event); }});
    ASSERT_EQ(events.size(), 3u) << name;
    const double fall = std::sqrt(2 / 9.81);
    double t = fall, flight = 2 * fall;
    for (const DaeEvent& event : events) {
      EXPECT_NEAR(event.t, t, 1e-10) << name;
      EXPECT_NEAR(event.gap, 0, 1e-9) << name;
      flight *= dae.e;
      t += flight;
    }
  }
}

TEST(Integrators, ClocksStrikeOnTime) {
  for (const std::string& name : available()) {
    JumpingBall dae;
    const DaeState end = run(name, dae, 1.0, {});
    EXPECT_EQ(end.mode.discrete[1], 3) << name;  // .3, .6, .9
  }
}

TEST(Integrators, OutputsStandOnTheirGridAndOnBothSidesOfAnEvent) {
  const JumpingBall dae;
  std::vector<double> times, speeds;
  run("dop853", dae, 0.5, {.output_step = 0.1, .on_output = [&](const DaeState& s) {
                             times.push_back(s.t), speeds.push_back(s.x[1]);
                             return true;
                           }});
  const double fall = std::sqrt(2 / 9.81);
  const std::vector<double> expected{0, 0.1, 0.2, 0.3, 0.3, 0.4, fall, fall, 0.5};
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(times[k], expected[k], 1e-11) << k;
  EXPECT_NEAR(speeds[7], -0.5 * speeds[6], 1e-12);
}

TEST(Integrators, TwoCallsAreOne) {
  const PlanarPendulum dae;
  const DaeState whole = run("dop853", dae, 2, {.rtol = 1e-11, .atol = 1e-12});
  DaeState state = initial_state_of(dae);
  const auto integrator = make_integrator("dop853", dae, {.rtol = 1e-11, .atol = 1e-12});
  for (const double t : {0.7, 1.1, 2.0}) integrator->advance(state, t);
  EXPECT_NEAR((state.x - whole.x).norm(), 0, 1e-9);
}

TEST(Integrators, StopWhereTheObserverSaysSo) {
  const JumpingBall dae;
  DaeState state = initial_state_of(dae);
  const auto integrator = make_integrator("dop853", dae, {.output_step = 0.1, .on_output = [](const DaeState& s) { return s.t < 0.15; }});
  EXPECT_EQ(integrator->advance(state, 1).status, IntegrationStatus::stopped);
  EXPECT_LT(state.t, 1);
}

TEST(Index, ASystemThatIsNotOfIndexOneIsToldSoWithItsRows) {
  PlanarPendulum dae;
  dae.is_index_3 = true;
  for (const std::string& name : available()) {
    DaeState state = initial_state_of(dae);
    const IntegrationResult result = make_integrator(name, dae, {})->advance(state, 1);
    EXPECT_EQ(result.status, IntegrationStatus::no_consistent_state);
    EXPECT_NE(result.explanation.find("rank 4 of 5"), std::string::npos) << result.explanation;
    EXPECT_NE(result.explanation.find("y1"), std::string::npos) << result.explanation;
  }
}

TEST(Index, OfAnIndexOneSystemIsFull) {
  const PlanarPendulum dae;
  DaeState state = initial_state_of(dae);
  Dae::Workspace workspace = dae.make_workspace();
  EXPECT_EQ(ConsistentStart(dae).diagnose(state, workspace).text(), "of index 1");
}

TEST(Options, AreNamedWhereTheyMakeNoSense) {
  const PlanarPendulum dae;
  EXPECT_THROW(make_integrator("dop853", dae, {.rtol = 0}), std::invalid_argument);
  EXPECT_THROW(make_integrator("dop583", dae), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
