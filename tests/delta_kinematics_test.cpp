// The delta robot's kinematics and dynamics: against tables computed elsewhere, and the laws that hold for every robot.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tenon/core/csv.hpp"
#include "tenon/tests/delta_robots.hpp"

namespace tenon::delta {
namespace {

const std::filesystem::path kSourceDir = TENON_SOURCE_DIR;
constexpr int kRobots = 12, kPoses = 10;

template <class Law>
void for_random_configurations(Law&& law) {
  std::mt19937_64 random(1);
  for (int k = 0; k < kRobots; ++k) {
    const Robot robot = test_robot(k, random);
    for (int pose = 0; pose < kPoses; ++pose) {
      SCOPED_TRACE(robot.name + ", robot " + std::to_string(k) + ", pose " + std::to_string(pose));
      law(robot, random_configuration(robot, random), random);
    }
  }
}

/// A block of columns name11, name12, ... of one row as a matrix.
template <int Rows, int Cols>
Eigen::Matrix<double, Rows, Cols> matrix_of(const CsvTable& table, std::size_t row, const std::string& name) {
  Eigen::Matrix<double, Rows, Cols> m;
  for (int a = 0; a < Rows; ++a) {
    for (int b = 0; b < Cols; ++b) m(a, b) = table[name + std::to_string(a + 1) + std::to_string(b + 1)][row];
  }
  return m;
}

template <int Size>
Eigen::Matrix<double, Size, 1> vector_of(const CsvTable& table, std::size_t row, const std::string& name) {
  Eigen::Matrix<double, Size, 1> v;
  for (int a = 0; a < Size; ++a) v[a] = table[name + std::to_string(a + 1)][row];
  return v;
}

Vector9 as_vector(const Matrix3& rows_of_arms) {
  Vector9 q;
  for (int i = 0; i < kArms; ++i) q.segment<3>(3 * i) = rows_of_arms.row(i);
  return q;
}

template <class A, class B>
double difference(const A& a, const B& b) {
  return (a - b).template lpNorm<Eigen::Infinity>();
}

void expect_statics(const CsvTable& table, std::size_t row, const Robot& robot, const Vector9& q, const std::string& exact,
                    const std::string& left) {
  const Configuration at(q);
  const Motion motion(robot, at);
  const ArmConstants k(robot);
  const Vector3 torque = vector_of<3>(table, row, "tau");
  const Vector6 lambda = vector_of<6>(table, row, "lambda");
  const Matrix3 inertia = matrix_of<3, 3>(table, row, exact), projected = matrix_of<3, 3>(table, row, left);
  EXPECT_LE(difference(gravity_torque(k, at, motion), torque), 1e-11 * torque.norm());
  EXPECT_LE(difference(gravity_closure_forces(robot, at, motion), lambda), 1e-11 * lambda.norm());
  EXPECT_LE(difference(reduced_inertia(k, at, motion), inertia), 1e-11 * inertia.norm());
  EXPECT_LE(difference(reduced_inertia(k, at, motion, ReducedInertia::projected_left), projected), 1e-11 * projected.norm());
}

void expect_jacobians(const CsvTable& table, std::size_t row, const Robot& robot, const Vector9& q) {
  const Configuration at(q);
  const double reach = robot.proximal_length + robot.distal_length;
  EXPECT_LE(difference(Motion(robot, at).jacobian, (matrix_of<3, 3>(table, row, "Jc"))), 1e-12 * reach);
  EXPECT_LE(difference(simulation_jacobian(robot, at), (matrix_of<3, 9>(table, row, "Jv"))), 1e-12 * reach);
}

TEST(DeltaTable, FiftyDigitArithmeticAgrees) {
  const CsvTable table = read_csv((kSourceDir / "tests/delta_poses.csv").string());
  const Robot robots[] = {load_robot("delta"), load_robot("delta-demo")};
  ASSERT_EQ(table.rows(), 7);
  for (std::size_t row = 0; row < 7; ++row) {
    SCOPED_TRACE(row);
    const Robot& robot = robots[static_cast<std::size_t>(table["robot"][row])];
    const Inverse inverse = inverse_kinematics(robot, {table["zx"][row], table["zy"][row], table["zz"][row]});
    ASSERT_TRUE(inverse.ok());
    EXPECT_LE(difference(inverse.q, as_vector(matrix_of<3, 3>(table, row, "q"))), 1e-13);
    expect_jacobians(table, row, robot, inverse.q);
    expect_statics(table, row, robot, inverse.q, "My", "Left");
  }
}

TEST(DeltaTable, TheReferencePosesAgree) {
  const std::string stem = (kSourceDir / "../shared/reference/deltaB_").string();
  if (!std::filesystem::exists(stem + "ik.csv")) GTEST_SKIP() << stem << "ik.csv is not there";
  const CsvTable poses = read_csv(stem + "ik.csv"), jacobians = read_csv(stem + "jac.csv"),
                 statics = read_csv(stem + "gravity_inertia.csv");
  const Robot robot = load_robot("delta");
  ASSERT_EQ(poses.rows(), 20);
  for (std::size_t row = 0; row < 20; ++row) {
    SCOPED_TRACE(row);
    const Inverse inverse = inverse_kinematics(robot, {poses["zx"][row], poses["zy"][row], poses["zz"][row]});
    ASSERT_TRUE(inverse.ok());
    EXPECT_LE(difference(inverse.q, as_vector(matrix_of<3, 3>(poses, row, "q"))), 1e-11);
    const Configuration at(inverse.q);
    const Motion motion(robot, at);
    EXPECT_LE(difference(motion.b, vector_of<3>(poses, row, "b")), 1e-12);
    EXPECT_NEAR(motion.det_a, poses["detA"][row], 1e-12);
    expect_jacobians(jacobians, row, robot, inverse.q);
    expect_statics(statics, row, robot, inverse.q, "MyExact", "MySlide");
  }
}

TEST(DeltaKinematics, InverseClosesTheArmsAndForwardUndoesIt) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    const double reach = robot.proximal_length + robot.distal_length;
    const Configuration at(q);
    EXPECT_LE(closure(robot, at).lpNorm<Eigen::Infinity>(), 1e-14 * reach);
    const Vector3 y(q[0], q[3], q[6]);
    const Forward forward = forward_kinematics(robot, y);
    ASSERT_TRUE(forward.ok());
    EXPECT_LE(difference(forward.wrist, wrist_position(robot, at)), 1e-13 * reach);
    EXPECT_LE(difference(angles(forward.at), q), 1e-12);
    Vector9 guess = q + 0.05 * random_vector(random, 1).replicate<3, 1>();
    const Forward newton = forward_newton(robot, y, guess);
    ASSERT_TRUE(newton.ok());
    EXPECT_LE(difference(newton.wrist, forward.wrist), 1e-13 * reach);
    EXPECT_LE(difference(guess, q), 1e-12);
  });
}

TEST(DeltaKinematics, JacobiansAreDerivatives) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    constexpr double kStep = 1e-6;
    const Configuration at(q);
    Vector9 v;
    for (int i = 0; i < kArms; ++i) v.segment<3>(3 * i) = random_vector(random, 2);
    const Configuration ahead(Vector9(q + kStep * v)), behind(Vector9(q - kStep * v));
    const Vector6 h_rate = (closure(robot, ahead) - closure(robot, behind)) / (2 * kStep);
    const Vector6 h_bias = (closure_jacobian(robot, ahead) - closure_jacobian(robot, behind)) * v / (2 * kStep);
    const Vector3 z_rate = (wrist_position(robot, ahead) - wrist_position(robot, behind)) / (2 * kStep);
    const double scale = 1e-8 * (robot.proximal_length + robot.distal_length);
    EXPECT_LE(difference(closure_jacobian(robot, at) * v, h_rate), scale);
    EXPECT_LE(difference(closure_bias(robot, at, v), h_bias), scale);
    EXPECT_LE(difference(simulation_jacobian(robot, at) * v, z_rate), scale);
  });
}

TEST(DeltaKinematics, MotionsOfTheMotorsKeepTheArmsClosed) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    const Configuration at(q);
    const Motion motion(robot, at);
    const Matrix93 gamma = motion.gamma_matrix();
    const double reach = robot.proximal_length + robot.distal_length;
    EXPECT_LE(difference(closure_jacobian(robot, at) * gamma, Eigen::Matrix<double, 6, 3>::Zero()), 1e-12 * reach);
    EXPECT_LE(difference(simulation_jacobian(robot, at) * gamma, motion.jacobian), 1e-12 * reach);
    for (int i = 0; i < kArms; ++i) EXPECT_EQ(gamma.row(3 * i), Matrix3::Identity().row(i));
    // the same a moment later:  Gamma' y' and J_c' y'
    const Vector3 y_rate = random_vector(random, 2);
    const Vector9 v = motion.rates(y_rate);
    constexpr double kStep = 1e-5;
    const auto motion_at = [&](double t) {
      Vector9 guess = q;
      return Motion(robot, forward_newton(robot, Vector3(q[0], q[3], q[6]) + t * y_rate, guess).at);
    };
    const Motion ahead = motion_at(kStep), behind = motion_at(-kStep);
    const MotionBias bias = motion_bias(robot, at, motion, v);
    const Vector9 gamma_bias = (ahead.rates(y_rate) - behind.rates(y_rate)) / (2 * kStep);
    EXPECT_LE(difference(bias.gamma, gamma_bias), 1e-6 * (1 + gamma_bias.norm()));
    EXPECT_LE(difference(bias.wrist, (ahead.jacobian - behind.jacobian) * y_rate / (2 * kStep)), 1e-6 * reach * (1 + gamma_bias.norm()));
    EXPECT_LE(difference(closure_jacobian(robot, at) * bias.gamma, -closure_bias(robot, at, v)), 1e-11 * reach * (1 + gamma_bias.norm()));
  });
}

TEST(DeltaKinematics, TheDeterminantOfTheUnmeasuredAnglesIsThatOfTypeTwo) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64&) {
    const Configuration at(q);
    const Matrix69 h = closure_jacobian(robot, at);
    Eigen::Matrix<double, 6, 6> h_x;
    for (int i = 0; i < kArms; ++i) h_x.middleCols<2>(2 * i) = h.middleCols<2>(3 * i + 1);
    const double expected = std::pow(robot.distal_length, 6) * Motion(robot, at).det_a * at[0].s2 * at[1].s2 * at[2].s2;
    EXPECT_NEAR(h_x.determinant(), expected, 1e-12 * std::pow(robot.distal_length, 6));
  });
}

TEST(DeltaKinematics, APoseOutOfReachIsNamedWithItsDistance) {
  const Robot robot = load_robot("delta");
  EXPECT_EQ(inverse_kinematics(robot, {0, 0, 0.7}).unreachable_arm, 0);
  EXPECT_EQ(inverse_kinematics(robot, {0, 0.5, 0.4}).unreachable_arm, 1);
  EXPECT_EQ(inverse_kinematics(robot, {0, 0, std::nan("")}).unreachable_arm, 0);
  EXPECT_NEAR(distance_to_workspace(robot, {0, 0, 0.7}), 0.7 - std::sqrt(0.65 * 0.65 - 0.05 * 0.05), 1e-12);
  EXPECT_EQ(distance_to_workspace(robot, {0.05, 0, 0.4}), 0);
  // the nearest point is on the border: a little nearer along any line nothing is reached, and a sample finds nothing nearer
  std::mt19937_64 random(3);
  for (int k = 0; k < 50; ++k) {
    const Vector3 z = random_vector(random, 1).normalized() * 0.8;
    const double distance = distance_to_workspace(robot, z);
    ASSERT_GT(distance, 0);
    for (int n = 0; n < 2000; ++n) {
      const Vector3 near = z + 0.999 * distance * random_vector(random, 1).normalized();
      ASSERT_FALSE(inverse_kinematics(robot, near).ok()) << z.transpose();
    }
    bool reached = false;
    for (int n = 0; n < 20000 && !reached; ++n) {
      reached = inverse_kinematics(robot, z + 1.02 * distance * random_vector(random, 1).normalized()).ok();
    }
    EXPECT_TRUE(reached) << z.transpose();
  }
}

TEST(DeltaKinematics, ForwardSaysWhereItEnds) {
  const Robot robot = load_robot("delta");
  EXPECT_EQ(forward_kinematics(robot, {0, 0, 0}).status, ForwardStatus::solved);
  Robot short_links = robot;
  short_links.distal_length = 0.2;
  EXPECT_EQ(forward_kinematics(short_links, {0, 0, 0}).status, ForwardStatus::unreachable);
  short_links.distal_length = 0.25;  // the elbows' circle: the wrist is among them
  EXPECT_EQ(forward_kinematics(short_links, {0, 0, 0}).status, ForwardStatus::singular);
  Vector9 guess = Vector9::Constant(1);
  guess[1] = 0;
  EXPECT_EQ(forward_newton(robot, {0, 0, 0}, guess).status, ForwardStatus::singular);
  Robot one_point = robot;  // elbows on one point
  one_point.base_radius = one_point.wrist_radius = 0.1;
  EXPECT_EQ(forward_kinematics(one_point, Vector3::Constant(std::acos(-1.0) / 2)).status, ForwardStatus::singular);
}

TEST(DeltaDynamics, GravityIsTheGradientOfThePotential) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64&) {
    constexpr double kStep = 1e-5;
    const ArmConstants k(robot);
    const Configuration at(q);
    for (int j = 0; j < 9; ++j) {
      const double g = gravity(k, at[j / 3])[j % 3];
      const Vector9 step = kStep * Vector9::Unit(j);
      const double slope =
          (potential_energy(k, Configuration(Vector9(q + step))) - potential_energy(k, Configuration(Vector9(q - step)))) / (2 * kStep);
      EXPECT_NEAR(g, slope, 1e-8 * (1 + std::abs(g)));
    }
  });
}

TEST(DeltaDynamics, CoriolisForcesTakeTheWorkOfTheChangingInertia) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    // c = Mdot v - (1/2) d(v' M v)/dq, by differences
    constexpr double kStep = 1e-5;
    const ArmConstants k(robot);
    for (int i = 0; i < kArms; ++i) {
      const Vector3 v = random_vector(random, 3);
      const auto m_at = [&](const Vector3& dq) {
        Vector9 moved = q;
        moved.segment<3>(3 * i) += dq;
        return ArmInertia(k, Configuration(moved)[i]).matrix();
      };
      Vector3 c = (m_at(kStep * v) - m_at(-kStep * v)) * v / (2 * kStep);
      for (int j = 0; j < 3; ++j) {
        const Vector3 step = kStep * Vector3::Unit(j);
        c[j] -= v.dot((m_at(step) - m_at(-step)) * v) / (4 * kStep);
      }
      EXPECT_LE(difference(coriolis(k, Configuration(q)[i], v), c), 1e-8 * (1 + c.norm()));
    }
  });
}

TEST(DeltaDynamics, TheReducedInertiaIsSymmetricAndPositiveAndItsEnergyIsTheWhole) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    const ArmConstants k(robot);
    const Configuration at(q);
    const Motion motion(robot, at);
    const Matrix3 inertia = reduced_inertia(k, at, motion);
    EXPECT_LE(difference(inertia, inertia.transpose()), 1e-14 * inertia.norm());
    EXPECT_EQ(inertia.llt().info(), Eigen::Success);
    const Vector3 y_rate = random_vector(random, 3);
    const double energy = kinetic_energy(k, at, motion.rates(y_rate));
    EXPECT_NEAR(y_rate.dot(inertia * y_rate) / 2, energy, 1e-12 * energy);
  });
}

TEST(DeltaDynamics, TheIndexOneFormAcceleratesAsMinimalCoordinatesDo) {
  for_random_configurations([](const Robot& robot, const Vector9& q, std::mt19937_64& random) {
    const ArmConstants k(robot);
    const Configuration at(q);
    const Motion motion(robot, at);
    const Vector3 y_rate = random_vector(random, 3), u = random_vector(random, 2), f = random_vector(random, 5);
    const Vector9 v = motion.rates(y_rate);
    const MotionBias bias = motion_bias(robot, at, motion, v);
    // M_y y'' = u + J_c' f - Gamma' (C + D + G + M gbar)
    Vector9 force;
    for (int i = 0; i < kArms; ++i) {
      const Vector3 rate = v.segment<3>(3 * i);
      force.segment<3>(3 * i) = coriolis(k, at[i], rate) + k.damping.cwiseProduct(rate) + gravity(k, at[i]) +
                                ArmInertia(k, at[i]) * Vector3(bias.gamma.segment<3>(3 * i));
    }
    const Vector3 y_acceleration =
        reduced_inertia(k, at, motion).llt().solve(u + motion.jacobian.transpose() * f - to_motors(motion, force));
    const Vector9 minimal = motion.rates(y_acceleration) + bias.gamma;
    const Acceleration index_1 = acceleration(robot, k, at, v, u, f);
    EXPECT_LE(difference(index_1.v_rate, minimal), 1e-10 * (1 + minimal.lpNorm<Eigen::Infinity>()));
  });
}

/// Arm 1 points outward and the elbows of arms 2 and 3 are led past each other: det A changes its sign there.
Vector9 type_two_configuration(const Robot& robot) {
  double before = 1.75, after = 1.9;
  const auto forward = [&](double y) { return forward_kinematics(robot, {0.2, y, y}); };
  for (int k = 0; k < 16; ++k) {
    const double middle = (before + after) / 2;
    (Motion(robot, forward(middle).at).det_a > 0 ? before : after) = middle;
  }
  return angles(forward(before).at);
}

TEST(DeltaDynamics, TheIndexOneFormSolvesItsTwentyFourEquationsAtEverySingularity) {
  const Robot robot = load_robot("delta");
  const ArmConstants k(robot);
  std::mt19937_64 random(5);
  const double reach = std::sqrt(0.65 * 0.65 - 0.05 * 0.05);
  const Vector9 stretched = inverse_kinematics(robot, {0, 0, reach * (1 - 1e-15)}).q, flat = type_two_configuration(robot);
  const auto measure = [&](const Vector9& q) { return Motion(robot, Configuration(q)).singularity(robot, Configuration(q)); };
  EXPECT_LE(measure(stretched).type_1, 1e-7);
  EXPECT_LE(measure(flat).type_2, 1e-5);
  for (const Vector9& q : {stretched, flat, random_configuration(robot, random)}) {
    const Configuration at(q);
    Vector9 v;
    for (int i = 0; i < kArms; ++i) v.segment<3>(3 * i) = random_vector(random, 1);
    const Vector3 u = random_vector(random, 1), f = random_vector(random, 1);
    const Acceleration a = acceleration(robot, k, at, v, u, f);
    const Matrix69 h = closure_jacobian(robot, at);
    Vector9 balance = simulation_jacobian(robot, at).transpose() * f + h.transpose() * a.lambda;
    for (int i = 0; i < kArms; ++i) {
      const Vector3 rate = v.segment<3>(3 * i);
      balance.segment<3>(3 * i) -= ArmInertia(k, at[i]) * Vector3(a.v_rate.segment<3>(3 * i)) + coriolis(k, at[i], rate) +
                                   k.damping.cwiseProduct(rate) + gravity(k, at[i]);
      balance[3 * i] += u[i];
    }
    const double p = robot.stabilisation;
    const Vector6 closing = h * a.v_rate + closure_bias(robot, at, v) + 2 * p * h * v + p * p * closure(robot, at);
    EXPECT_LE(balance.lpNorm<Eigen::Infinity>(), 1e-11);
    EXPECT_LE(closing.lpNorm<Eigen::Infinity>(), 1e-10);
  }
}

}  // namespace
}  // namespace tenon::delta
