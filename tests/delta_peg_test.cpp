// The peg in the delta's wrist: the planar task's program, estimator and baselines with another plant.
#include <gtest/gtest.h>

#include <algorithm>

#include "tenon/core/input_error.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/delta_plant.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::peg {
namespace {

/// A scene's closed loop, and the columns of its record by name.
class Loop {
 public:
  explicit Loop(const std::string& scene, const std::vector<std::string>& overrides = {})
      : task_(tenon::make_task(scene, overrides)),
        controller_(take_controller(task_, "mpc", make_newton_kkt)),
        loop_(*task_.plant, *controller_, task_.duration),
        columns_(loop_.columns()) {}

  template <class OnRow>
  void run(std::uint64_t seed, const OnRow& on_row) {
    loop_.run(seed, [&](const Vector& row) {
      on_row(row);
      return true;
    });
  }
  double operator()(const Vector& row, const std::string& column) const {
    const auto at = std::ranges::find(columns_, column) - columns_.begin();
    EXPECT_LT(at, row.size()) << column;
    return row[at];
  }
  double verdict(const std::string& name) const {
    Vector values(task_.plant->num_verdicts());
    task_.plant->verdicts(values);
    for (int i = 0; i < values.size(); ++i)
      if (task_.plant->verdict_name(i) == name) return values[i];
    ADD_FAILURE() << "no verdict " << name;
    return 0;
  }

 private:
  ControlTask task_;
  std::unique_ptr<Controller> controller_;
  ClosedLoop loop_;
  std::vector<std::string> columns_;
};

void expect_success(Loop& loop, int samples) {
  for (int seed = 1; seed <= samples; ++seed) {
    loop.run(static_cast<std::uint64_t>(seed), [](const Vector&) {});
    EXPECT_EQ(loop.verdict("success"), 1) << "seed " << seed;
    EXPECT_LE(loop.verdict("time"), 2) << "seed " << seed;
    EXPECT_LE(loop.verdict("sustained_force"), 8) << "seed " << seed;
  }
}

TEST(DeltaPeg, FindsTheHoleOfBothSettings) {
  Loop wide("peg-in-hole-delta"), tight("peg-in-hole-tight", {"plant.robot=\"delta\""});
  expect_success(wide, 4);
  expect_success(tight, 4);
}

TEST(DeltaPeg, ClosesItsLoopsAndStaysWithinItsTorques) {
  Loop loop("peg-in-hole-delta");
  const delta::Robot robot = delta::load_robot("delta");
  double most = 0;
  loop.run(2, [&](const Vector& row) {
    delta::Vector9 q;
    for (int i = 0; i < 9; ++i) q[i] = loop(row, "q" + std::to_string(i / 3 + 1) + std::to_string(i % 3 + 1));
    EXPECT_LE(closure(robot, delta::Configuration(q)).lpNorm<Eigen::Infinity>(), 1e-8);
    EXPECT_LE(loop(row, "closure"), 1e-8);
    const delta::Vector3 wrist = wrist_position(robot, delta::Configuration(q));
    EXPECT_NEAR(wrist[0], loop(row, "x"), 1e-12) << "the wrist is where the gimbals' axes meet, at the tip";
    EXPECT_NEAR(0.4 - wrist[2], loop(row, "z"), 1e-12);
    for (const char* name : {"torque1", "torque2", "torque3"}) {
      EXPECT_LE(std::abs(loop(row, name)), robot.torque_limit);
      most = std::max(most, std::abs(loop(row, name)));
    }
    for (const char* name : {"torque_yaw", "torque_pitch", "torque_roll"}) EXPECT_LE(std::abs(loop(row, name)), robot.gimbal_torque_limit);
    for (const char* name : {"yaw", "roll"}) EXPECT_LE(std::abs(loop(row, name)), 1e-6) << "the task is planar";
  });
  EXPECT_GE(most, 0.5) << "the arms carry their weight";
}

/// The reference held still 2 mm below the flat: the peg rests on its spring, at K (r - q) = F.
TEST(DeltaPeg, EstimatesAContactForceAtRest) {
  ControlTask task = tenon::make_task("peg-in-hole-delta", {"offset_x=0.005"});
  Vector command = Vector::Zero(kCommands), y(kMeasurements), truth(task.plant->num_outputs());
  command.segment<3>(kStiffness) << 1e3, 1e3, 3;
  task.plant->reset(0);
  for (int k = 0; k < 100; ++k) {
    command[kReference + 1] = 1e-3 * (5 - 0.07 * k);  // 2 mm below the flat in the end
    task.plant->advance(0.01 * (k + 1), command);
  }
  task.plant->advance(1.3, command);
  task.plant->measure(y);
  task.plant->outputs(truth);
  const Vector3d force = truth.segment<3>(9);  // Fx, Fz, My
  EXPECT_NEAR(force[1], 1.9, 0.1) << "1.93 mm of 1 N/mm";
  for (int i : {0, 1}) EXPECT_NEAR(y[kMeasuredForce + i], force[i], 0.1);
  EXPECT_NEAR(y[kMeasuredForce + 2], force[2], 1e-3);
}

TEST(DeltaPeg, RepeatsARunBitForBit) {
  Loop loop("peg-in-hole-delta"), again("peg-in-hole-delta");
  std::vector<Vector> first;
  loop.run(4, [&](const Vector& row) { first.push_back(row); });
  std::size_t k = 0;
  again.run(3, [](const Vector&) {});
  again.run(4, [&](const Vector& row) {
    for (int i = 0; i < row.size(); ++i) EXPECT_EQ(row[i], first[k][i]) << "column " << i << " in row " << k;
    ++k;
  });
  EXPECT_EQ(k, first.size());
}

TEST(DeltaPeg, TellsWhatIsWrongWithItsRobot) {
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole-delta", {"plant.robot=\"detla\""}), InputError, "plant.robot");
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole-delta", {"plant.robot=\"delta-demo\""}), InputError, "no gimbals");
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole-delta", {"plant.peg_mass=-1"}), InputError, "peg_mass is -1");
}

}  // namespace
}  // namespace tenon::peg
