// Vehicles as files: the built-in ones read, write and read back; nonsense is refused with its place.
#include "tenon/problems/allocation/vehicle_file.hpp"

#include <gtest/gtest.h>

#include "tenon/core/input_error.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon {
namespace {

TEST(VehicleFile, TheBuiltInVehiclesAreTheOnesPromised) {
  EXPECT_EQ(builtin_vehicles(), (std::vector<std::string>{"fixed-tilt-hexa", "flat-hexa", "momav", "momav-bench", "tilt-quad"}));
  for (const std::string& name : builtin_vehicles()) {
    const VehicleFile file = load_vehicle(name);
    EXPECT_EQ(file.vehicle.name, name);
    EXPECT_TRUE(file.notes.empty()) << file.notes.front();
    EXPECT_TRUE(file.vehicle.hard_limits);
    EXPECT_FALSE(describe_builtin_vehicle(name).empty());
  }
}

TEST(VehicleFile, MomavIsThePublishedOne) {
  const Vehicle momav = load_vehicle("momav").vehicle;
  ASSERT_EQ(momav.num_rotors(), 6);
  EXPECT_EQ(momav.mass, 2.5);
  EXPECT_EQ(momav.weights.angle_rate_soft, 3.14);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(momav.rotors[static_cast<std::size_t>(i)].spin, i % 2 == 0 ? -1 : 1);
  EXPECT_NEAR(momav.rotors[2].axis.norm(), 1, 1e-15);
}

TEST(VehicleFile, WhatIsWrittenReadsBackBitForBit) {
  for (const std::string& name : builtin_vehicles()) {
    Vehicle vehicle = load_vehicle(name).vehicle;
    vehicle.rotors[0].fails_at = 1.25;
    vehicle.rotors[1].angle_lower = -3;
    vehicle.rotors[1].angle_upper = 4;
    const Vehicle back = parse_vehicle(to_toml(vehicle), "x.toml").vehicle;
    EXPECT_EQ(to_toml(back), to_toml(vehicle));
    for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
      EXPECT_EQ(back.rotors[i].axis, vehicle.rotors[i].axis);
      EXPECT_EQ(back.rotors[i].zero, vehicle.rotors[i].zero);
      EXPECT_EQ(back.rotors[i].tilt, vehicle.rotors[i].tilt);
      EXPECT_EQ(back.rotors[i].angle_rate_limit, vehicle.rotors[i].angle_rate_limit);
    }
  }
}

TEST(VehicleFile, ADirectionThatIsNotOfUnitLengthIsBroughtToItWithANote) {
  const VehicleFile file = load_vehicle("tilt-quad", {"rotor.2.zero=[0, 0, 2]"});
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0], "tilt-quad: rotor 2: zero has length 2, brought to 1");
  EXPECT_EQ(file.vehicle.rotors[1].zero, Eigen::Vector3d(0, 0, 1));
}

TEST(VehicleFile, RefusesWhatMakesNoSense) {
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.3.axis=[0,0,0]"}), InputError, "rotor 3: axis is zero");
  EXPECT_MESSAGE(load_vehicle("tilt-quad", {"rotor.1.zero=[1,1,0]"}), InputError, "zero is parallel to axis");
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.1.spin=2"}), InputError, "rotor 1: spin is 2 (expected 1 or -1)");
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.1.thrust=[]"}), InputError, "thrust has no coefficients");
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.1.thrust=[0,-1]"}), InputError, "expected a thrust that rises");
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.1.throttle=[1,0]"}), InputError, "throttle is [1, 0]");
  EXPECT_MESSAGE(load_vehicle("momav", {"rotor.1.angle_rate_limit=0"}), InputError, "angle_rate_limit is 0");
  EXPECT_MESSAGE(load_vehicle("momav", {"weights.force_error=0"}), InputError, "weights.force_error is 0");
  EXPECT_MESSAGE(load_vehicle("momav", {"weights.throtle=0"}), InputError, "the nearest known key is 'throttle'");
  EXPECT_MESSAGE(load_vehicle("momav", {"mass=0"}), InputError, "mass is 0 kg");
  EXPECT_MESSAGE(load_vehicle("momaf"), std::invalid_argument, "the nearest is 'momav'");
  EXPECT_MESSAGE(load_vehicle("no.toml"), InputError, "no.toml: cannot be read");
  EXPECT_MESSAGE(parse_vehicle("mass = 1", "x.toml"), InputError, "there are 0 rotors (expected 3 to 12)");
  std::string many = "mass = 1\n";
  for (int i = 0; i < 700; ++i) many += "[[rotor]]\nposition=[0,0,0]\naxis=[1,0,0]\nzero=[0,0,1]\nspin=1\nthrust=[0,1]\ntorque=[0,1]\n";
  EXPECT_MESSAGE(parse_vehicle(many, "x.toml"), InputError, "there are 700 rotors (expected 3 to 12)");
}

TEST(VehicleFile, TheErrorStandsWhereTheValueDoes) {
  const std::string text =
      "mass = 1\n[[rotor]]\nposition = [0, 0, 0]\naxis = [1, 0, 0]\nzero = [0, 0, 1]\nspin = 3\nthrust = [0, 1]\ntorque = [0, 1]\n";
  EXPECT_MESSAGE(parse_vehicle(text + text.substr(9) + text.substr(9), "x.toml"), InputError, "x.toml:6:8: rotor 1: spin is 3");
}

TEST(VehicleFile, ReadsTheSolverTable) {
  const SolverChoice choice = load_vehicle("momav", {"solver.name=ipopt", "solver.tolerance=1e-9", "solver.max_iterations=7"}).solver;
  EXPECT_EQ(choice.name, "ipopt");
  EXPECT_EQ(choice.tolerance, 1e-9);
  EXPECT_EQ(choice.max_iterations, 7);
}

}  // namespace
}  // namespace tenon
