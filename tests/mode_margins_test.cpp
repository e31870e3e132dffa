// Margins of linear modes against what is known in closed form.
#include <cmath>

#include <gtest/gtest.h>

#include "tenon/mpc/mode_margins.hpp"

namespace tenon {
namespace {

constexpr double kPi = 3.14159265358979323846;

Eigen::MatrixXd one(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

LinearMode mass_with_impedance(double mass, double stiffness, double damping, double period) {
  return {"free", one(mass), one(stiffness), one(damping), one(0), one(0), period, 0};
}

// A stiffness that only keeps the position from drifting.
constexpr double kAlmostNone = 1e-3;

// L = D e^{-sT}/(M s): crossover w = D/M, phase margin pi/2 - w T, so the loop bears a delay of pi/(2w) in all; half a period is spent on the hold.
TEST(ModeMargins, OfAPureDamperBearTheDelayOfTheirPhase) {
  const double crossover = 20, period = 1e-4;
  const ModeMargins margins = mode_margins(mass_with_impedance(0.5, kAlmostNone, 0.5 * crossover, period));
  EXPECT_TRUE(margins.stable);
  EXPECT_TRUE(std::isinf(margins.delay));  // 78 ms are more than 100 periods
  const ModeMargins slow = mode_margins(mass_with_impedance(0.5, kAlmostNone, 0.5 * crossover, 2e-3));
  EXPECT_NEAR(slow.delay, kPi / (2 * crossover) - 1e-3, 1e-4);
}

// x_{k+1} = x_k - w h x_{k-d}: with d = 0 stable up to w h = 2, and with a delay of a whole period up to w h = 1.
TEST(ModeMargins, KnowTheSampling) {
  const double period = 1e-2;
  EXPECT_TRUE(mode_margins(mass_with_impedance(1, kAlmostNone, 1.99 / period, period)).stable);
  EXPECT_FALSE(mode_margins(mass_with_impedance(1, kAlmostNone, 2.01 / period, period)).stable);
  LinearMode late = mass_with_impedance(1, kAlmostNone, 0.99 / period, period);
  late.delay = period;
  EXPECT_TRUE(mode_margins(late).stable);
  late.damping = one(1.01 / period);
  EXPECT_FALSE(mode_margins(late).stable);
  EXPECT_NEAR(mode_margins(mass_with_impedance(1, kAlmostNone, 1 / period, period)).delay, period, 1e-6);
}

// Re 1/Y = D cos(wT) - K sin(wT)/w: passive up to where tan(wT) = w D/K.
TEST(ModeMargins, LosePassivityToTheDelay) {
  LinearMode mode = mass_with_impedance(0.8, 1000, 2 * std::sqrt(800.0), 1e-3);
  EXPECT_NEAR(mode_margins(mode).passive_below, 500, 1e-9);  // half of the sampling rate: throughout
  mode.delay = 5e-3;
  const double end = mode_margins(mode).passive_below, w = 2 * kPi * end, late = 5.5e-3;
  EXPECT_NEAR(std::atan(w * mode.damping(0, 0) / 1000) / late, w, 0.01 * w);
  EXPECT_LT(mode_margins(mode).modulus, 0.95);
}

// A stiffer contact takes phase from the loop: with no damping of its own it is borne up to a bound, and that falls with the delay.
TEST(ModeMargins, BearContactsUpToAStiffness) {
  LinearMode mode = mass_with_impedance(0.8, 1000, 2 * std::sqrt(800.0), 1e-3);
  mode.contact_stiffness = one(2e4);
  mode.delay = 1e-3;
  const ModeMargins near = mode_margins(mode);
  ASSERT_TRUE(near.stable);
  EXPECT_TRUE(std::isfinite(near.contact_stiffness));
  mode.contact_stiffness = one(2e4 * near.contact_stiffness * 0.999);
  EXPECT_TRUE(mode_margins(mode).stable);
  mode.contact_stiffness = one(2e4 * near.contact_stiffness * 1.001);
  EXPECT_FALSE(mode_margins(mode).stable);
}

// Two modes side by side have the margins of the worse.
TEST(ModeMargins, OfTwoAxesAreThoseOfTheWorse) {
  LinearMode two{"two", Eigen::Vector2d(1, 2).asDiagonal(), Eigen::Vector2d(100, 900).asDiagonal(), Eigen::Vector2d(20, 5).asDiagonal(),
                 Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero(), 1e-3, 2e-3};
  const ModeMargins both = mode_margins(two);
  double modulus = INFINITY, delay = INFINITY;
  for (int i = 0; i < 2; ++i) {
    LinearMode single{"one", one(two.mass(i, i)), one(two.stiffness(i, i)), one(two.damping(i, i)), one(0), one(0), 1e-3, 2e-3};
    const ModeMargins margins = mode_margins(single);
    modulus = std::min(modulus, margins.modulus), delay = std::min(delay, margins.delay);
  }
  EXPECT_NEAR(both.modulus, modulus, 1e-9);
  EXPECT_NEAR(both.delay, delay, 1e-6);
}

TEST(ModeMargins, AskForMatricesThatFit) {
  LinearMode mode = mass_with_impedance(1, 1, 1, 1e-3);
  mode.damping = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_THROW(mode_margins(mode), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
