// Contact as physics: the sources' numbers, momentum and energy across impacts, rest, and the work of every multiplier accounted for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

using contact::ImpactLaw;

const double kGravity = 9.81;

// Without gravity a linear law h'' + 2 zeta h' + h = 0 released at h'' = 0 rebounds with e(zeta): MODELS.md, section 3.
TEST(Law, RestitutionIsWhatTheLinearLawGives) {
  for (const double zeta : {0.05, 0.3, 0.9, 1.0, 1.5, 3.0}) {
    const contact::Law law{1, 2 * zeta, 0};
    const auto path = contact::collision_path(law, 1, 2000);
    EXPECT_NEAR(path.back().rate, contact::restitution_of(zeta), 1e-10) << zeta;
    EXPECT_NEAR(path.back().acceleration, 0, 1e-10) << zeta;
    for (const auto& point : path) EXPECT_GE(point.acceleration, -1e-9) << "the law pulls before release, zeta " << zeta;
  }
  EXPECT_NEAR(contact::restitution_of(1), std::exp(-2.0), 1e-14);
  EXPECT_NEAR(contact::restitution_of(0.1), 0.74407939772184850, 1e-10);
}

TEST(Law, FollowsFromRestitutionAndContactTime) {
  for (const double e : {0.05, 0.3, 0.8, 1.0}) {
    const contact::Law law = contact::law_of(e, 2e-3);
    EXPECT_NEAR(contact::restitution_of(law.alpha1 / (2 * std::sqrt(law.alpha0))), e, 1e-12);
    EXPECT_NEAR(contact::contact_time_of(law), 2e-3, 1e-14);
  }
}

// beta0 = 0: e depends on zeta_c = beta1 beta3^-1/4 v^-1/2 alone: MODELS.md, section 3.
TEST(Law, WithACubicSpringSettlesSlowCollisions) {
  const double expected[][2] = {{0.1, .835445332574}, {1, .181401620746}};
  for (const auto& [zeta, e] : expected) {
    for (const double stiffness : {1.0, 1e8}) {
      const double v = 0.7, beta1 = zeta * std::pow(stiffness, 0.25) * std::sqrt(v);
      const contact::Law law{0, beta1, stiffness};
      EXPECT_NEAR(contact::rebound_of(law, v).restitution, e, 1e-10) << zeta;
      const auto path = contact::collision_path(law, v, 50);
      EXPECT_NEAR(path.back().rate, e * v, 1e-10) << zeta;
      EXPECT_NEAR(path.back().acceleration / path[25].acceleration, 0, 1e-9) << zeta;
      const Eigen::MatrixXd A = Eigen::MatrixXd::Constant(1, 1, 1 / 0.3);
      const std::vector<contact::Touching> touching{{.collision = law}};
      for (const ImpactLaw impact : {ImpactLaw::sequential, ImpactLaw::compliant})
        EXPECT_NEAR(contact::resolve(impact, A, Vector::Constant(1, -v), touching).rates[0], e * v, 1e-7) << zeta;
    }
  }
  // a spring of both terms, without damping, gives back what it was given; with a cubic term of nothing it is the linear one
  EXPECT_NEAR(contact::rebound_of({1e4, 0, 1e8}, 2).restitution, 1, 1e-10);
  const contact::Rebound linear = contact::rebound_of({1e4, 20, 0}, 2), nearly = contact::rebound_of({1e4, 20, 1e-12}, 2);
  EXPECT_NEAR(nearly.restitution, linear.restitution, 1e-9);
  EXPECT_NEAR(nearly.time, linear.time, 1e-9 * linear.time);
}

TEST(BouncingBallRestitution, ReboundsByACubicLawTheLessTheSlowerItComes) {
  const SceneRun run = run_scene(contact::parse_scene(R"(
      [simulation]
      gravity = [-9.81, 0.0]
      duration = 2.0
      [[body]]
      name = "ball"
      kind = "line"
      mass = 1.0
      position = [1.0, 0.0]
      [[shape]]
      body = "ball"
      type = "point"
      [[shape]]
      name = "ground"
      type = "half-plane"
      normal = [1.0, 0.0]
      [[contact]]
      name = "ground"
      between = ["ball", "ground"]
      collision = [0.0, 200.0, 1e12]
  )",
                                                      "ball.toml"));
  const auto hits = run.events_to(1);
  ASSERT_GE(hits.size(), 3u);
  double slower = 1;
  for (int k = 0; k < 3; ++k) {
    const double v = -hits[static_cast<std::size_t>(k)].gap_rate_before, e = hits[static_cast<std::size_t>(k)].gap_rate_after / v;
    EXPECT_NEAR(e, contact::rebound_of({0, 200, 1e12}, v).restitution, 1e-12);
    EXPECT_LT(e, slower);
    slower = e;
  }
  EXPECT_LT(run.largest("energy_error"), 1e-9);
}

class BouncingBall : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, BouncingBall, testing::Values("dop853", "ida"));

TEST_P(BouncingBall, MeetsTheSourcesNumbers) {
  const SceneRun run = run_scene("bouncing-ball", {}, GetParam(), 1e-10);
  const auto hits = run.events_to(1), releases = run.events_from(1, 0);
  ASSERT_EQ(hits.size(), 3u);
  ASSERT_EQ(releases.size(), 2u) << "the third impact is kept";
  const double times[] = {0.451523640986, 1.015103836, 1.304346227};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(hits[k].t, times[k], 1e-8);
  EXPECT_NEAR(hits[0].gap_rate_before, -4.429446918070, 1e-8);
  EXPECT_NEAR(releases[0].t, 0.493431548557, 1e-8);
  EXPECT_NEAR(releases[0].gap, -0.0339902376, 1e-8);
  EXPECT_NEAR(releases[0].gap_rate_after, 2.6239588734, 1e-7);
  // the apex follows from the release: h + v^2 / 2g
  EXPECT_NEAR(releases[0].gap + std::pow(releases[0].gap_rate_after, 2) / (2 * kGravity), 0.316935357172, 1e-8);
  EXPECT_NEAR(releases[1].gap + std::pow(releases[1].gap_rate_after, 2) / (2 * kGravity), 0.0541932637, 1e-8);
  EXPECT_LT(run.largest("energy_error"), 1e-9 * 9.81 * (std::string(GetParam()) == "ida" ? 1e3 : 1))
      << "BDF at 1e-10 accumulates over its steps";
}

TEST(BouncingBallOneLaw, GainsWithoutDampingWhatTheFormulaSays) {
  const SceneRun run = run_scene("bouncing-ball", {"alpha1=0", "simulation.duration=0.6"}, "dop853", 1e-11);
  const auto releases = run.events_from(1, 0);
  ASSERT_GE(releases.size(), 1u);
  const double h = releases[0].gap, gain = kGravity * h - 100 * h * h / 2 - 1e6 * std::pow(h, 4) / 4;
  EXPECT_NEAR(releases[0].energy_after - 9.81, gain, 1e-8);
}

TEST(BouncingBallOneLaw, DoesNotBounceWithoutTheCubicTerm) {
  const SceneRun run = run_scene("bouncing-ball", {"alpha3=0"});
  EXPECT_TRUE(run.events_from(1, 0).empty());
  EXPECT_EQ(run.final.mode.discrete[0], contact::kContact);
}

TEST(BouncingBallRestitution, RestsAtTheZenoTimeWithItsWeight) {
  const SceneRun run = run_scene("bouncing-ball-restitution");
  double apex = 1;
  const auto hits = run.events_to(1);
  for (int n = 0; n < 10; ++n, apex *= 0.64) EXPECT_NEAR(std::pow(hits[n].gap_rate_before, 2) / (2 * kGravity), apex, 1e-6) << n;
  const auto rests = run.events_to(2);
  ASSERT_EQ(rests.size(), 1u);
  EXPECT_NEAR(rests[0].t, 4.063712768871578, 1e-4);
  EXPECT_NEAR(run.final.y[0], kGravity, 1e-9);
  EXPECT_GT(run.smallest("gap_ground"), -1e-9) << "no tunnelling";
}

TEST(BouncingBallRestitution, StartsTouchingAtRestOrWithTinyVelocity) {
  for (const char* velocity : {"0.0", "-1e-7", "-1e-12", "1e-7", "1e-12"}) {
    const SceneRun run = run_scene("bouncing-ball-restitution",
                                   {"height=0", std::string("body.1.velocity=[") + velocity + ", 0.0]", "simulation.duration=0.5"});
    EXPECT_EQ(run.final.mode.discrete[0], contact::kContact) << velocity;
    EXPECT_NEAR(run.final.y[0], kGravity, 1e-9) << velocity;
    EXPECT_NEAR(run.final.x[0], 0, 1e-9) << velocity;
  }
}

TEST(Cradle, KBallsInKBallsOut) {
  for (int k = 1; k <= 4; ++k) {
    const SceneRun run = run_scene("cradle", {"released=" + std::to_string(k), "simulation.duration=0.511"});
    const double v = std::sqrt(2 * kGravity * (1 - std::cos(std::numbers::pi / 6)));
    for (int ball = 0; ball < 5; ++ball) {
      const double speed = run.final.x.segment<2>(4 * ball + 2).norm();
      EXPECT_NEAR(speed, ball >= 5 - k ? v : 0, 1e-5) << k << " released, ball " << ball + 1;  // .7 ms of swing after the impact
    }
  }
}

TEST(Cradle, KeepsMomentumAcrossImpactsAndEnergyOverTenSwings) {
  const SceneRun run = run_scene("cradle");
  const double swing = kGravity * (1 - std::cos(std::numbers::pi / 6));
  EXPECT_LT(run.largest("energy_error"), 1e-8 * swing);
  EXPECT_NEAR(run.last("energy"), run.column("energy")[0], 1e-8 * swing);
  EXPECT_EQ(run.events_to(1).size(), 40u) << "ten impacts of four pairs";
  const auto& dae = static_cast<const contact::ContactDae<2>&>(*run.dae);
  // just before and after an event: two rows at one time
  int impacts = 0;
  for (std::size_t k = 1; k < run.states.size(); ++k) {
    if (run.states[k].t != run.states[k - 1].t) continue;
    ++impacts;
    EXPECT_NEAR(dae.momentum(run.states[k].x)[0], dae.momentum(run.states[k - 1].x)[0], 1e-12) << run.states[k].t;
  }
  EXPECT_EQ(impacts, 10);
}

TEST(Cradle, LosesWhatTheSequenceOfPairCollisionsLoses) {
  for (const double e : {0.9, 0.5}) {
    // a chain of pairs: each passes (1 + e) / 2 of its speed on and keeps (1 - e) / 2; slower followers do not catch up within the phase
    double v[5] = {1, 0, 0, 0, 0};
    for (int round = 0; round < 1000; ++round) {
      int fastest = -1;
      for (int i = 0; i < 4; ++i) {
        if (v[i] - v[i + 1] > 1e-10 && (fastest < 0 || v[i] - v[i + 1] > v[fastest] - v[fastest + 1] + 1e-12)) fastest = i;
      }
      if (fastest < 0) break;
      const double closing = v[fastest] - v[fastest + 1], p = 0.5 * (1 + (closing < 1e-9 ? 0 : e)) * closing;
      v[fastest] -= p, v[fastest + 1] += p;
    }
    const Eigen::MatrixXd A = (Eigen::MatrixXd(4, 4) << 2, -1, 0, 0, -1, 2, -1, 0, 0, -1, 2, -1, 0, 0, -1, 2).finished();
    const Vector w = (Vector(4) << -1, 0, 0, 0).finished();
    const auto phase =
        contact::resolve(ImpactLaw::sequential, A, w, std::vector<contact::Touching>(4, {.restitution = e, .rest_speed = 1e-9}));
    ASSERT_TRUE(phase.failure.empty());
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(phase.rates[i], v[i + 1] - v[i], 1e-8) << e << ", pair " << i + 1;
  }
}

/// Ball velocities of a cradle of five after the first of them arrives with speed 1.
std::vector<double> cradle_outcome(ImpactLaw law) {
  const Eigen::MatrixXd A = (Eigen::MatrixXd(4, 4) << 2, -1, 0, 0, -1, 2, -1, 0, 0, -1, 2, -1, 0, 0, -1, 2).finished();
  const auto phase = contact::resolve(law, A, (Vector(4) << -1, 0, 0, 0).finished(), std::vector<contact::Touching>(4));
  EXPECT_TRUE(phase.failure.empty()) << phase.failure;
  std::vector<double> v{1, 0, 0, 0, 0};
  for (int i = 0; i < 4; ++i) v[static_cast<std::size_t>(i)] -= phase.impulses[i], v[static_cast<std::size_t>(i) + 1] += phase.impulses[i];
  return v;
}

TEST(Cradle, EachImpactLawGivesItsOutcome) {
  const double compliant[] = {-.1322794847, -.0753291698, -.0310108290, .2962177501, .9424017334}, coupled[] = {-.6, .4, .4, .4, .4};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(cradle_outcome(ImpactLaw::sequential)[static_cast<std::size_t>(i)], i == 4 ? 1 : 0, 1e-12);
    EXPECT_NEAR(cradle_outcome(ImpactLaw::compliant)[static_cast<std::size_t>(i)], compliant[i], 1e-6);
    EXPECT_NEAR(cradle_outcome(ImpactLaw::coupled)[static_cast<std::size_t>(i)], coupled[i], 1e-12);
  }
  EXPECT_NEAR(cradle_outcome(ImpactLaw::hertz)[4], .9887774241, 1e-6);
}

// A solid disc lands sliding: A_nn = 1/m, A_tt = 1/m + r^2/J = 3/m. The normal impulse is (1 + e) m v; the tangent slides on it or comes to
// a stop. Where a body turns about the normal's impulse too (A_nt) the work still is what the kinetic energy changes by.
TEST(Friction, OfACompliantImpactSlidesOrSticks) {
  const double e = 0.5, v = 2, mass = 0.4, mu = 0.3;
  const std::vector<contact::Touching> disc{{.restitution = e, .friction = mu}};
  for (const double coupling : {0.0, 0.8}) {
    const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 2) << 1, coupling, coupling, 3).finished() / mass;
    for (const double slip : {0.5, 2.0, 5.0, -5.0}) {
      const Vector before = (Vector(2) << -v, slip).finished();
      const auto phase = contact::resolve(ImpactLaw::compliant, A, before, disc, 1);
      ASSERT_TRUE(phase.failure.empty());
      const double cone = mu * phase.impulses[0];
      EXPECT_LE(std::abs(phase.impulses[1]), cone * (1 + 1e-9)) << slip;
      const double energy = 0.5 * (phase.rates.dot(A.inverse() * phase.rates) - before.dot(A.inverse() * before));
      EXPECT_NEAR(phase.works.sum(), energy, 1e-12) << slip;
      EXPECT_NEAR(phase.events.front().work, energy, 1e-12) << slip;
      if (coupling != 0) continue;
      EXPECT_NEAR(phase.rates[0], e * v, 1e-6) << slip;
      EXPECT_NEAR(cone, mu * (1 + e) * mass * v, 1e-6) << slip;
      EXPECT_NEAR(phase.rates[1], std::abs(slip) <= 3 * cone / mass ? 0 : slip - std::copysign(3 * cone / mass, slip), 1e-6) << slip;
    }
  }
}

TEST(BoxInCorner, RestsOnExactForcesAndItsPeakIsTheLaws) {
  std::vector<double> peaks;
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const SceneRun run = run_scene("box-in-corner", {"simulation.output_step=1e-4"}, "dop853", rtol);
    const Vector floor = run.column("lambda_floor_1") + run.column("lambda_floor_2"),
                 wall = run.column("lambda_wall_2") + run.column("lambda_wall_3");
    if (rtol < 1e-7) {  // lambda = m (alpha1 h' + alpha0 h) + what rests: the state's error enters a hundredfold
      EXPECT_NEAR(floor[floor.size() - 1], kGravity + 5, 1e-9);
      EXPECT_NEAR(wall[wall.size() - 1], 20, 1e-9);
    }
    peaks.push_back(wall.maxCoeff());
    EXPECT_NEAR(peaks.back(), 100 * std::sqrt(2 * 20 * 0.05) + 20, rtol < 1e-7 ? 1e-4 : 0.04)
        << "at the touch the law asks for h'' = -alpha1 h'";
  }
  EXPECT_NEAR(peaks[1], peaks[2], 1e-4);
  EXPECT_NEAR(peaks[0], peaks[2], 0.04) << "at 1e-6 the box arrives tilted by its error, and its corners touch one after the other";
}

TEST(FallingBody, TakesItsSequenceOfModes) {
  const SceneRun run = run_scene("falling-body");
  std::vector<std::string> hits;
  for (const DaeEvent& event : run.events_to(1)) {
    if (hits.empty() || hits.back() != event.contact) hits.push_back(event.contact);
  }
  ASSERT_GE(hits.size(), 3u);
  EXPECT_EQ(hits[0], "h3");
  EXPECT_EQ(hits[1], "h4");
  EXPECT_EQ(hits[2], "h3");
  for (const DaeEvent& event : run.events) EXPECT_NE(event.contact, "h5");
  const std::vector<int> modes(run.final.mode.discrete);
  EXPECT_EQ(modes, (std::vector<int>{2, 2, 2, 2, 0}));
  EXPECT_NEAR(run.last("lambda_h3") + run.last("lambda_h4"), kGravity, 1e-8);
  EXPECT_NEAR(run.last("lambda_h1") + run.last("lambda_h2"), 5 * kGravity, 1e-8);
}

// A box lands flat with one corner held: it lets go of it iff half height a > sqrt(2) half width b, where 1/m - b^2/J > 0.
TEST(FallingBody, AHeldCornerLetsGoOfATallBox) {
  for (const double ratio : {0.5, 1.0, 1.4, 1.43, 2.0, 4.0}) {
    const double b = 0.1, a = ratio * b, J = (a * a + b * b) / 3;
    const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 2) << 1 + b * b / J, 1 - b * b / J, 1 - b * b / J, 1 + b * b / J).finished();
    const auto phase = contact::resolve(ImpactLaw::sequential, A, (Vector(2) << 0, -1).finished(),
                                        {{.restitution = 0, .is_held = true}, {.restitution = 0}});
    EXPECT_EQ(phase.is_held[0] == 0, ratio > std::numbers::sqrt2) << ratio;
  }
}

// A box that rocks to rest opens one corner at each blow on the other, slower each time: the last blow keeps both.
TEST(FallingBody, RocksToRestInFiniteTime) {
  const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 2) << 1.3, 0.7, 0.7, 1.3).finished();
  const std::vector<contact::Touching> corners(2, {.restitution = 0});
  const auto fast = contact::resolve(ImpactLaw::sequential, A, (Vector(2) << -5e-4, 0).finished(), corners);
  EXPECT_FALSE(fast.is_held[1]);
  EXPECT_NEAR(fast.rates[1], 5e-4 * 0.7 / 1.3, 1e-15);
  const auto last = contact::resolve(ImpactLaw::sequential, A, (Vector(2) << -5e-7, 0).finished(), corners);
  EXPECT_TRUE(last.is_held[0] && last.is_held[1]);
  EXPECT_EQ(last.rates, Vector::Zero(2));
}

TEST(RockingBlock, LosesSpeedAtEachImpactAsHousnerFound) {
  const SceneRun run = run_scene("rocking-block");
  // omega+ / omega- = 1 - 3/2 sin^2 alpha about a corner that does not slide; the corner that rises carries the ratio
  const double sine2 = 0.1 * 0.1 / (0.1 * 0.1 + 0.4 * 0.4), ratio = 1 - 1.5 * sine2;
  std::vector<double> rates;
  for (const DaeEvent& event : run.events_to(1)) rates.push_back(-event.gap_rate_before);
  ASSERT_GE(rates.size(), 4u);
  for (int k = 1; k < 4; ++k) EXPECT_NEAR(rates[static_cast<std::size_t>(k)] / rates[static_cast<std::size_t>(k) - 1], ratio, 5e-3) << k;
}

TEST(RopeSway, SwingsInItsFirstMode) {
  const SceneRun run = run_scene("rope-sway");
  const Vector t = run.column("t"), x = run.column("x40");
  std::vector<double> crossings;
  for (int k = 1; k < x.size(); ++k) {
    if ((x[k - 1] > 0) != (x[k] > 0) && t[k - 1] > 0.1) crossings.push_back(t[k - 1] - x[k - 1] * (t[k] - t[k - 1]) / (x[k] - x[k - 1]));
  }
  ASSERT_GE(crossings.size(), 3u);
  const double omega = std::numbers::pi / (crossings[1] - crossings[0]);
  EXPECT_NEAR(omega, 1.2024 * std::sqrt(kGravity), 0.02 * 1.2024 * std::sqrt(kGravity)) << "forty beads hang half a link lower than a rope";
}

TEST(BoxStack, FourRedundantCornersShareTheWeight) {
  const SceneRun run = run_scene("box-stack", {"boxes=1", "gap=0"});
  EXPECT_NEAR(run.last("lambda_floor_1") + run.last("lambda_floor_2"), kGravity, 1e-9);
  const SceneRun stack = run_scene("box-stack");
  EXPECT_NEAR(stack.last("lambda_floor_1") + stack.last("lambda_floor_2"), 5 * kGravity, 1e-6);
  for (int i = 1; i <= 5; ++i)
    EXPECT_NEAR(stack.last("y" + std::to_string(i)), 0.2 * (i - 0.5), 1e-6) << "box " << i << " stands on the others";
}

TEST(CableSway, StrikesThePostAndKeepsItsAudit) {
  const SceneRun run = run_scene("cable-sway", {"simulation.duration=1.5"});
  EXPECT_GE(run.events_to(1).size(), 1u);
  const Vector energy = run.column("energy");
  EXPECT_LT(run.largest("energy_error"), 1e-6 * 2.5) << "the cable's energy over its fall";
  EXPECT_LE(energy[energy.size() - 1], energy[0] + 1e-6) << "restitution below 1 takes energy";
}

// Links pull on both their beads alike: only weight and the pot change the chain's momentum. Looked at while no bead that touches is past
// the flat.
TEST(ChainFountain, ChangesItsMomentumByWeightAndPotAlone) {
  const SceneRun run = run_scene("chain-fountain", {"simulation.duration=0.2"});
  EXPECT_LT(run.largest("energy_error"), 1e-7);
  EXPECT_GE(run.events.size(), 50u) << "beads rest in the pot";
  constexpr int kBeads = 100, kLinks = 99;
  int looked_at = 0;
  for (const DaeState& state : run.states) {
    bool is_flat = true;
    double pot = 0, x = 0, y = 0;
    for (int k = 0; k < kBeads; ++k) x += 0.002 * state.xdot[4 * k + 2], y += 0.002 * state.xdot[4 * k + 3];
    for (int c = kLinks; c < state.y.size(); ++c) {
      const int bead = 20 + c - kLinks;
      pot += state.y[c];
      is_flat &= state.mode.discrete[static_cast<std::size_t>(c)] == contact::kFree || state.x[4 * bead] < 0;
    }
    if (!is_flat) continue;
    ++looked_at;
    EXPECT_NEAR(x, 0, 1e-9) << state.t;
    EXPECT_NEAR(y, pot - 0.002 * kBeads * kGravity, 1e-9) << state.t;
  }
  EXPECT_GE(looked_at, 3);
}

// Over the rim a bead comes from a face onto a corner: the gap's curvature jumps. Each feature is a mode of its own, so that the tolerance
// is met by steps that grow slowly, and what the run loses does not depend on it.
TEST(ChainFountain, ConvergesThoughItsBeadsGoRoundACorner) {
  std::vector<double> energies;
  std::vector<long> steps;
  for (const double rtol : {1e-5, 1e-6, 1e-7}) {
    const SceneRun run = run_scene("chain-fountain", {}, "dop853", rtol);
    energies.push_back(run.last("energy"));
    steps.push_back(run.result.steps);
    double exchanged = run.column("energy")[0] - run.last("energy");
    EXPECT_GT(exchanged, 0.03) << "J, lost in collisions";
    for (int bead = 0; bead < 100; ++bead) exchanged += 0.5 * 0.002 * run.final.x.segment<2>(4 * bead + 2).squaredNorm();
    EXPECT_LT(run.largest("energy_error"), std::max(1e-6, 0.5 * rtol) * exchanged) << exchanged;
  }
  EXPECT_NEAR(energies[0], energies[2], 2e-4);
  EXPECT_NEAR(energies[1], energies[2], 2e-5);
  EXPECT_LT(steps[2], 2 * steps[0]);
}

TEST(Jacobian, AgreesWithDifferencesInEveryMode) {
  for (const char* scene :
       {"bouncing-ball", "cradle", "falling-body", "circuit-breaker", "car", "paper-clip", "ball-and-cup", "box-stack"}) {
    check_jacobian(contact::load_scene(scene), 1e-6);
  }
}

TEST(Integrators, AgreeOnTheModesOfAScene) {
  const SceneRun a = run_scene("ball-and-cup", {}, "dop853", 1e-9), b = run_scene("ball-and-cup", {}, "ida", 1e-9);
  ASSERT_GE(a.events.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(a.events[k].contact, b.events[k].contact);
    EXPECT_EQ(a.events[k].to, b.events[k].to);
    EXPECT_NEAR(a.events[k].t, b.events[k].t, 1e-5);
  }
}

}  // namespace
}  // namespace tenon
