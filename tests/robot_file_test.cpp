// Delta robots as files: the built-in ones read, write and read back; nonsense is refused with its place.
#include "tenon/problems/delta/robot_file.hpp"

#include <gtest/gtest.h>

#include "tenon/core/input_error.hpp"
#include "tenon/problems/delta/robot_keys.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta {
namespace {

TEST(RobotFile, TheBuiltInRobotsAreTheOnesPromised) {
  EXPECT_EQ(builtin_robots(), (std::vector<std::string>{"delta", "delta-demo"}));
  for (const std::string& name : builtin_robots()) {
    EXPECT_EQ(load_robot(name).name, name);
    EXPECT_FALSE(describe_builtin_robot(name).empty());
  }
  EXPECT_NEAR(load_robot("delta").tip_mass(), 0.1, 1e-16);
  EXPECT_NEAR(load_robot("delta-demo").tip_mass(), 0.3, 1e-16);
  EXPECT_EQ(load_robot("delta-demo").torque_limit, std::numeric_limits<double>::infinity());
}

TEST(RobotFile, WhatIsWrittenReadsBackBitForBit) {
  for (const std::string& name : builtin_robots()) {
    const Robot robot = load_robot(name, {"payload=0.123456789012345678"});
    const Robot back = parse_robot(to_toml(robot), "x.toml");
    for (const RobotKey& key : kRobotKeys) EXPECT_EQ(back.*key.field, robot.*key.field) << key.name;
    for (const RobotVectorKey& key : kRobotVectorKeys) EXPECT_EQ(back.*key.field, robot.*key.field) << key.name;
  }
}

TEST(RobotFile, RefusesWhatMakesNoSense) {
  EXPECT_MESSAGE(load_robot("delta", {"distal_length=0"}), InputError, "distal_length is 0 m (expected more than 0)");
  EXPECT_MESSAGE(load_robot("delta", {"base_radius=0.9"}), InputError, "distal_length is 0.45 m, too short for the arms to meet");
  EXPECT_MESSAGE(load_robot("delta", {"payload=-1"}), InputError, "payload is -1 kg (expected 0 or more)");
  EXPECT_MESSAGE(load_robot("delta", {"wrist_mass=0", "distal_inertia=0"}), InputError, "a distal link that has inertia");
  EXPECT_MESSAGE(load_robot("no.toml"), InputError, "no.toml: cannot be read");
  EXPECT_MESSAGE(parse_robot("base_radius = 1", "x.toml"), InputError, "x.toml");
}

TEST(RobotFile, TheErrorStandsWhereTheValueDoes) {
  std::string text = to_toml(load_robot("delta"));
  text.replace(text.find("wrist_mass = 0.3"), 16, "wrist_mass = -30");
  EXPECT_MESSAGE(parse_robot(text, "x.toml"), InputError, "x.toml:10:14: wrist_mass is -30 kg (expected 0 or more)");
}

}  // namespace
}  // namespace tenon::delta
