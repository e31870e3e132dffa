// tenon robot, as a script sees it.
#include <gtest/gtest.h>

#include <cmath>

#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class RobotVerb : public testing::Test {
 protected:
  Ended run(const std::string& arguments) { return run_tenon(folder_, "robot " + arguments); }

  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, "robot " + arguments, line);
  }

  ScratchFolder folder_;
};

TEST_F(RobotVerb, TheRobotsHaveNames) {
  const Ended ended = run_tenon(folder_, "list robots");
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.out.find("delta-demo"), std::string::npos) << ended.out;
}

TEST_F(RobotVerb, AnswersOneOfTheTwoWaysAround) {
  const Ended inverse = run("delta --inverse -0.1,0,0.3 --json");
  EXPECT_EQ(inverse.code, 0) << inverse.err;
  for (const char* key : {"\"schema\": 1", "\"q\": [", "-0.350612279823", "\"z\": ["}) {
    EXPECT_NE(inverse.out.find(key), std::string::npos) << key << inverse.out;
  }
  const Ended forward = run("delta --forward -0.350612279823681,-0.725430019692412,0.0273437773274074 --json --jacobians");
  EXPECT_EQ(forward.code, 0) << forward.err;
  for (const char* key : {"\"Jc\": [", "\"Jv\": [", "\"My\": [", "\"gravity_torque\": [", "2.12764867342"}) {
    EXPECT_NE(forward.out.find(key), std::string::npos) << key << forward.out;
  }
}

TEST_F(RobotVerb, MapsTheWorkspace) {
  const Ended ended = run("delta --workspace map.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  const CsvTable map = read_csv(folder_.path("map.csv"));
  EXPECT_GT(map.rows(), 5000);
  for (int k = 0; k < map.rows(); ++k) {
    const std::size_t row = static_cast<std::size_t>(k);
    EXPECT_LE(std::hypot(map["zx"][row], map["zy"][row], map["zz"][row]), 0.7);
    EXPECT_GE(map["type_1"][row], 0);
    EXPECT_LE(map["type_2"][row], 1);
    EXPECT_LE(map["speed_least"][row], map["speed_greatest"][row]);
  }
}

TEST_F(RobotVerb, TheTactileLoopSoftensTheGraspInABandAsItsLinearModelSays) {
  const Ended ended = run("delta --impedance curve.csv --json");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("\"phase_deg\": "), std::string::npos) << ended.out;
  const CsvTable curve = read_csv(folder_.path("curve.csv"));
  ASSERT_GE(curve.rows(), 40);
  for (std::size_t k = 0; k < static_cast<std::size_t>(curve.rows()); ++k) {
    EXPECT_NEAR(curve["impedance_off"][k], curve["linear_off"][k], 0.04 * curve["linear_off"][k]) << curve["frequency"][k];
    EXPECT_NEAR(curve["impedance_on"][k], curve["linear_on"][k], 0.04 * curve["linear_on"][k]) << curve["frequency"][k];
    if (curve["frequency"][k] < 12) {
      EXPECT_LT(curve["impedance_on"][k], 0.7 * curve["impedance_off"][k]);
      EXPECT_GT(curve["wrist_on"][k], curve["wrist_off"][k]);
    }
  }
}

TEST_F(RobotVerb, RefusesWhatMakesNoSense) {
  expect_bad_input("dleta", "unknown robot 'dleta', the nearest is 'delta'");
  expect_bad_input("delta --inverse 0,0,0.7", "--inverse (0, 0, 0.7) is out of reach of arm 1, 0.0519259 m from the workspace");
  expect_bad_input("delta --inverse 0,0", "--inverse has 2 entries (expected 3)");
  expect_bad_input("delta --inverse 0,0,nan", "--inverse has the entry 'nan'");
  expect_bad_input("delta --inverse 0,0,0.4 --forward 0,0,0", "robot: --inverse and --forward both name a pose");
  expect_bad_input("delta --jacobians", "robot: --jacobians of which pose?");
  expect_bad_input("delta --set proximal_length=-1", "--set proximal_length=-1: proximal_length is -1 m (expected more than 0)");
  expect_bad_input("delta --set damping=[0,-1,0]", "--set damping=[0,-1,0]: damping is [0, -1, 0]");
  expect_bad_input("delta --set proximal_lenght=1",
                   "--set proximal_lenght=1: unknown key 'proximal_lenght'; the nearest known key is 'proximal_length'");
  expect_bad_input("delta --set distal_length=0.2 --forward 0,0,0", "--forward (0, 0, 0): the elbows are too far apart");
  expect_bad_input("delta --inverse 0,0,0.648074069840786 --jacobians", "the pose is at a singularity of type I");
  expect_bad_input("delta --forward 1.8234765819,1.8234765819,1.8234765819",
                   "--forward (1.82348, 1.82348, 1.82348) is at a singularity of type II");
  folder_.write("r.toml", "base_radius = 0.1\nproximal_length = 0.2\n");
  expect_bad_input("r.toml", "r.toml:1:1: ");
  EXPECT_EQ(run("delta --workspace nowhere/map.csv").code, 2);
}

TEST_F(RobotVerb, ItsScenesAreSimulatedUnderTheirNamesOrFromAFile) {
  const Ended step = run_tenon(folder_, "simulate delta-circle --set radius=0.03 --set simulation.duration=0.2 --output out.csv");
  EXPECT_EQ(step.code, 0) << step.err;
  const CsvTable table = read_csv(folder_.path("out.csv"));
  for (const char* name : {"zx", "zy", "zz", "q11", "q33", "v11", "v33", "tau1", "tau3", "energy", "energy_error"})
    EXPECT_TRUE(table.has(name));
  EXPECT_NEAR(table["zx"][0], 0.03, 1e-15);
  folder_.write("scene.toml", "[robot]\nmodel = \"delta-demo\"\n[reference]\ncentre = [0, 0, 2]\n[simulation]\nduration = 0.1\n");
  EXPECT_EQ(run_tenon(folder_, "simulate scene.toml --output demo.csv").code, 0);
  const Ended far = run_tenon(folder_, "simulate delta-circle --set radius=0.6 --output far.csv");
  EXPECT_EQ(far.code, 2);
  EXPECT_TRUE(is_one_line(far.err, "tenon: delta-circle:14:10: the reference (0.6, 0, 0.4) is out of reach, 0.183447 m from")) << far.err;
  EXPECT_FALSE(folder_.has("far.csv") || folder_.has("far.csv.partial"));
}

TEST_F(RobotVerb, WarnsNearASingularity) {
  const Ended ended = run("delta --inverse 0,0,0.648074");
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(is_one_line(ended.err, "tenon: the pose is near a singularity of type I: an arm is stretched or folded")) << ended.err;
}

}  // namespace
}  // namespace tenon
