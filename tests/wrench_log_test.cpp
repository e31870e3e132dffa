// Wrench logs and bench records: times, orientations, and what is refused.
#include "tenon/problems/allocation/wrench_log.hpp"

#include <gtest/gtest.h>

#include "tenon/core/input_error.hpp"
#include "tenon/problems/allocation/fit.hpp"
#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/scratch_folder.hpp"

namespace tenon {
namespace {

TEST(WrenchLog, ReadsTimesOrIntervals) {
  const auto timed = parse_wrench_log("t,Fx,Fy,Fz,Mx,My,Mz\n1,1,2,3,4,5,6\n1.5,0,0,0,0,0,0\n", "a.csv");
  EXPECT_EQ(timed[0].dt, 0.5);
  EXPECT_EQ(timed[1].dt, 0.5);
  EXPECT_EQ(timed[0].wrench, (Wrench() << 1, 2, 3, 4, 5, 6).finished());
  const auto stepped = parse_wrench_log("dt,Fx,Fy,Fz,Mx,My,Mz\n.25,1,2,3,4,5,6\n.5,0,0,0,0,0,0\n", "a.csv");
  EXPECT_EQ(stepped[0].t, 0);
  EXPECT_EQ(stepped[1].t, 0.5);
  EXPECT_EQ(stepped[0].dt, 0.25);
}

TEST(WrenchLog, TurnsTheWrenchIntoTheBody) {
  // The body is turned by 90 degrees about z: the world's x is the body's -y.
  const auto rows =
      parse_wrench_log("t,Fx,Fy,Fz,Mx,My,Mz,qw,qx,qy,qz\n0,1,0,3,0,2,0,0.70710678118654757,0,0,0.70710678118654757\n", "a.csv");
  EXPECT_TRUE(rows[0].wrench.isApprox((Wrench() << 0, -1, 3, 2, 0, 0).finished(), 1e-15));
}

TEST(WrenchLog, RefusesWhatMakesNoSense) {
  const std::string head = "t,Fx,Fy,Fz,Mx,My,Mz\n";
  EXPECT_MESSAGE(parse_wrench_log(head + "1,0,0,0,0,0,0\n1,0,0,0,0,0,0\n", "a.csv"), InputError, "a.csv:3: t goes from 1 to 1 s");
  EXPECT_MESSAGE(parse_wrench_log("dt,Fx,Fy,Fz,Mx,My,Mz\n-.1,0,0,0,0,0,0\n", "a.csv"), InputError,
                 "a.csv:2: dt is -0.1 s (expected more than 0)");
  EXPECT_MESSAGE(parse_wrench_log("Fx,Fy,Fz,Mx,My,Mz\n0,0,0,0,0,0\n", "a.csv"), InputError, "neither column 't' nor 'dt'");
  EXPECT_MESSAGE(parse_wrench_log("t,u,v\n0,0,0\n", "a.csv"), InputError, "column 'Fx' is missing in 't,u,v'");
  EXPECT_MESSAGE(parse_wrench_log("t,Fx,Fy,Fz,Mx,My,Mz,qw,qx\n0,0,0,0,0,0,0,1,0\n", "a.csv"), InputError, "the quaternion lacks column");
  EXPECT_MESSAGE(parse_wrench_log("t,Fx,Fy,Fz,Mx,My,Mz,qw,qx,qy,qz\n0,0,0,0,0,0,0,1,0,0,.01\n", "a.csv"), InputError,
                 "a.csv:2: the quaternion has length 1.00005");
}

TEST(Fit, RecoversAPolynomialAndReportsItsResidual) {
  std::vector<double> u, y;
  for (int k = 1; k <= 10; ++k) {
    u.push_back(k / 10.0);
    y.push_back(2 * u.back() + 3 * u.back() * u.back() + (k % 2 == 0 ? 1e-3 : -1e-3));
  }
  const PolynomialFit fit = fit_polynomial(u, y, 2, false);
  EXPECT_EQ(fit.coefficients.size(), 3u);
  EXPECT_EQ(fit.coefficients[0], 0);
  EXPECT_NEAR(fit.coefficients[1], 2, 1e-2);
  EXPECT_NEAR(fit.max_residual, 1e-3, 3e-4);
  EXPECT_TRUE(fit.rises);
  EXPECT_FALSE(fit_polynomial({0.2, 0.5, 1}, {1, 2, 1}, 2, false).rises);
  EXPECT_EQ(fit_polynomial({0.2, 0.5, 1}, {1.2, 1.5, 2}, 1, true).coefficients.size(), 2u);
}

TEST(Fit, TheBenchDataOfMomavGiveItsThrustMap) {
  const PolynomialFit fit = fit_polynomial({.3, .5, .7, .9, 1}, {3.93, 7, 10.83, 16.44, 19.94}, 2, false);
  EXPECT_NEAR(fit.coefficients[1], 8.0786, 1e-4);
  EXPECT_NEAR(fit.coefficients[2], 11.5415, 1e-4);
  EXPECT_NEAR(fit.max_residual, .48, 1e-3);
}

TEST(Fit, RefusesTooFewThrottlesAndOnesOutOfRange) {
  const ScratchFolder folder;
  EXPECT_MESSAGE(fit_bench(folder.write("a.csv", "u,thrust,torque\n.5,1,1\n.5,1,1\n")), InputError, "1 distinct throttles");
  EXPECT_MESSAGE(fit_bench(folder.write("b.csv", "u,thrust,torque\n1.5,1,1\n")), InputError, "b.csv:2:1: the throttle u is 1.5");
  EXPECT_MESSAGE(fit_bench(folder.write("c.csv", "u,thrust\n1,1\n")), InputError, "column 'torque' is missing");
  EXPECT_THROW(fit_polynomial({.5}, {1}, 9, false), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
