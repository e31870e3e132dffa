// Missions flown: errors no larger than the published flights', every limit kept, failures survived, a lost flight named.
#include "tenon/apps/flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/flight/mission_file.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon::flight {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
using Overrides = std::vector<std::string>;

struct Sample {
  double t;
  Vector x;
  FlightTick tick;
};

struct Flight {
  FlightResult result;
  std::vector<Sample> samples;  // one for each tick
  std::vector<DaeEvent> events;

  /// Largest errors from a time on: m, deg.
  double position_error(double begin) const {
    double most = 0;
    for (const Sample& s : samples) most = s.t >= begin ? std::max(most, s.tick.position_error) : most;
    return most;
  }
  double angle_error(double begin) const {
    double most = 0;
    for (const Sample& s : samples) most = s.t >= begin ? std::max(most, kDegrees * s.tick.angle_error) : most;
    return most;
  }
};

Flight fly_mission(const std::string& name, const Overrides& overrides = {}, const std::string& integrator = "dop853") {
  Flight flight;
  const FlightDae dae(load_mission(name, overrides), allocator_maker());
  flight.result = fly(dae,
                      {.on_tick =
                           [&](const DaeState& state, const FlightTick& tick) {
                             flight.samples.push_back({state.t, state.x, tick});
                             return true;
                           },
                       .on_event = [&](const DaeEvent& event) { flight.events.push_back(event); }},
                      integrator);
  return flight;
}

Overrides with_compensation(bool is_on) {
  return {std::string("controller.lag_compensation=") + (is_on ? "true" : "false")};
}

void expect_no_failure(const Flight& flight) {
  EXPECT_EQ(flight.result.status, IntegrationStatus::reached) << flight.result.explanation;
  EXPECT_EQ(flight.result.statistics.allocation_failures, 0);
  EXPECT_EQ(flight.result.statistics.limits_violated, 0);
}

/// The published flights' mean errors, in mm and degrees.
TEST(Flights, TheSweepsErrorsAreNoLargerThanThePublishedOnesAndWithLagCompensationAtMostHalf) {
  struct Published {
    const char* mission;
    double position, angle;
  };
  for (const Published& row : {Published{"position-sweep", 6.6, 2.1}, Published{"orientation-sweep", 11.8, 3.3}}) {
    for (const bool is_on : {false, true}) {
      const Flight flight = fly_mission(row.mission, with_compensation(is_on));
      expect_no_failure(flight);
      const double share = is_on ? 0.5 : 1;
      EXPECT_LE(1e3 * flight.result.statistics.position_error.mean(), share * row.position) << row.mission << " " << is_on;
      EXPECT_LE(kDegrees * flight.result.statistics.angle_error.mean(), share * row.angle) << row.mission << " " << is_on;
    }
  }
}

TEST(Flights, LagCompensationBringsTheVehicleNearerToWhereItShouldBeWhileItTurns) {
  for (const char* mission : {"orientation-sweep", "singular-crossing", "tumble", "figure-eight"}) {
    const double without = fly_mission(mission, with_compensation(false)).result.statistics.position_error.mean();
    const double with = fly_mission(mission, with_compensation(true)).result.statistics.position_error.mean();
    EXPECT_LE(with, 0.65 * without) << mission;
  }
}

TEST(Flights, GravityPassesAlongEveryArmWithoutAnAllocationFailure) {
  for (const bool is_on : {false, true}) {
    const Flight flight = fly_mission("singular-crossing", with_compensation(is_on));
    expect_no_failure(flight);
    const Vehicle vehicle = load_mission("singular-crossing").vehicle;
    for (const Rotor& rotor : vehicle.rotors) {
      double nearest = 180;
      for (const Sample& s : flight.samples) {
        const Vector3d down = Quaterniond(s.x[3], s.x[4], s.x[5], s.x[6]).conjugate() * Vector3d(0, 0, -1);
        nearest = std::min(nearest, kDegrees * std::acos(std::min(1.0, down.dot(rotor.axis))));
      }
      EXPECT_LE(nearest, 1) << "the arm along " << rotor.axis.transpose();
    }
    EXPECT_LE(flight.angle_error(0), 3) << is_on;
    EXPECT_LE(flight.position_error(0), 10e-3) << is_on;
  }
}

TEST(Flights, TenMinutesOfTumblingTurnTheArmsOnAndOnWithoutRewindingOrABranchTrap) {
  const Flight flight = fly_mission("tumble", {"simulation.duration=600"});
  expect_no_failure(flight);
  const Mission mission = load_mission("tumble");
  const LinearAllocation linear(mission.vehicle);
  const double most = mission.vehicle.rotors[0].angle_rate_limit * mission.controller.period * (1 + 1e-9);
  std::vector<double> over;
  double turns = 0;
  for (std::size_t k = 1; k < flight.samples.size(); ++k) {
    const FlightTick &last = flight.samples[k - 1].tick, &now = flight.samples[k].tick;
    const double change = (now.angle - last.angle).lpNorm<Eigen::Infinity>();
    ASSERT_LE(change, most) << "t = " << flight.samples[k].t;
    turns = std::max(turns, now.angle.lpNorm<Eigen::Infinity>() / (2 * std::numbers::pi));
    if (now.status == AllocationStatus::solved && change < 0.999 * most) {
      over.push_back(now.throttle.squaredNorm() / linear.effort_lower_bound(now.asked) - 1);
    }
  }
  EXPECT_GT(turns, 10);
  EXPECT_GT(over.size(), flight.samples.size() * 8 / 10);
  std::ranges::sort(over);
  EXPECT_LE(over[over.size() * 99 / 100], 0.02);
  // it was in all orientations: every direction of a grid has been down, to within 10 degrees
  constexpr int kDirections = 300;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, angle = i * 2.399963229728653, r = std::sqrt(1 - z * z);
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    const bool was_down = std::ranges::any_of(flight.samples, [&](const Sample& s) {
      return direction.dot(Quaterniond(s.x[3], s.x[4], s.x[5], s.x[6]).conjugate() * Vector3d(0, 0, -1)) > std::cos(10 / kDegrees);
    });
    ASSERT_TRUE(was_down) << direction.transpose();
  }
}

TEST(Flights, WhicheverRotorFailsTheVehicleHoldsItsPlaceAndRecoversItsAttitude) {
  for (int rotor = 1; rotor <= 6; ++rotor) {
    const Flight flight = fly_mission("rotor-failure", {"failure.1.rotor=" + std::to_string(rotor)});
    expect_no_failure(flight);
    ASSERT_FALSE(flight.events.empty());
    EXPECT_GT(flight.angle_error(2), 5) << "rotor " << rotor << " was not missed";
    EXPECT_LE(flight.position_error(0), 80e-3) << rotor;
    EXPECT_LE(flight.position_error(8), 5e-3) << rotor;
    EXPECT_LE(flight.angle_error(8), 1) << rotor;
    for (const Sample& s : flight.samples) {
      if (s.t > 2.2) {
        ASSERT_EQ(s.tick.throttle[rotor - 1], 0);
      }
    }
  }
}

TEST(Flights, WhicheverServoSticksTheVehicleHoldsItsPlaceAndRecoversItsAttitude) {
  for (int rotor = 1; rotor <= 6; ++rotor) {
    const Flight flight = fly_mission("servo-failure", {"failure.1.rotor=" + std::to_string(rotor)});
    expect_no_failure(flight);
    EXPECT_LE(flight.position_error(0), 20e-3) << rotor;
    EXPECT_LE(flight.position_error(10), 5e-3) << rotor;
    EXPECT_LE(flight.angle_error(10), 1) << rotor;
    const double stuck = flight.samples.back().x[13 + 6 + rotor - 1];
    for (const Sample& s : flight.samples) {
      if (s.t < 2.2) continue;
      ASSERT_EQ(s.x[13 + 6 + rotor - 1], stuck);
      ASSERT_NEAR(s.tick.angle[rotor - 1], stuck, 1e-9);
    }
  }
}

TEST(Flights, AFailureThatNobodyNoticesIsWorse) {
  const Flight known = fly_mission("rotor-failure");
  const Flight late = fly_mission("rotor-failure", {"failure.1.detection=0.4"});
  EXPECT_GT(late.angle_error(2), 1.5 * known.angle_error(2));
}

TEST(Flights, AVehicleThatCannotHoverOnFiveRotorsComesDownLevel) {
  const Flight flight = fly_mission("rotor-failure", {"payload.mass=2.5", "controller.mass=5"});
  EXPECT_EQ(flight.result.status, IntegrationStatus::transition_failed);
  EXPECT_NE(flight.result.explanation.find("hovering there takes 49 N, and the rotors give"), std::string::npos)
      << flight.result.explanation;
  EXPECT_LT(flight.samples.back().x[2], -0.9);
  EXPECT_LE(kDegrees * flight.samples.back().tick.angle_error, 10);
}

TEST(Flights, AnOverloadedVehicleIsLostAndItIsSaidWhy) {
  const Flight flight = fly_mission("overload");
  EXPECT_EQ(flight.result.status, IntegrationStatus::transition_failed);
  EXPECT_NE(
      flight.result.explanation.find("the flight is lost, 1 m from its reference; hovering there takes 68.6 N, and the rotors give 63.7 N"),
      std::string::npos)
      << flight.result.explanation;
  EXPECT_GT(flight.samples.size(), 100u);
  EXPECT_LE(flight.angle_error(0), 1);
}

TEST(Flights, GainsThatDestabiliseLoseTheFlightAndAreNamed) {
  const Flight slow = fly_mission("position-sweep", {"controller.force=[100,200,1]"});
  EXPECT_EQ(slow.result.status, IntegrationStatus::transition_failed);
  EXPECT_NE(slow.result.explanation.find("the force gains 100, 200, 1 make an unstable loop"), std::string::npos)
      << slow.result.explanation;
  const Flight wild = fly_mission("hover", {"controller.torque=[1.8,3.6,0.01]"});
  EXPECT_EQ(wild.result.status, IntegrationStatus::transition_failed);
  EXPECT_NE(wild.result.explanation.find("the torque gains 1.8, 3.6, 0.01 make an unstable loop"), std::string::npos)
      << wild.result.explanation;
}

TEST(Flights, AWindIsHeldAgainst) {
  const Flight steady = fly_mission("hover", {"wind.deviation=0", "wind.steady=[3,-2,1]"});
  EXPECT_LE(steady.position_error(10), 3e-3);  // what the integral is for
  const Flight gusts = fly_mission("hover");
  const Flight estimated = fly_mission("hover", {"controller.disturbance=1"});
  EXPECT_LE(estimated.result.statistics.position_error.mean(), 0.9 * gusts.result.statistics.position_error.mean());
}

TEST(Flights, DelaysAndLostMeasurementsAreFlownThrough) {
  for (const char* trouble : {"sensors.delay=4", "sensors.drop_out=0.5"}) {
    const Flight flight = fly_mission("orientation-sweep", {trouble});
    expect_no_failure(flight);
    EXPECT_LE(flight.result.statistics.position_error.mean(), 11.8e-3) << trouble;
    EXPECT_LE(kDegrees * flight.result.statistics.angle_error.mean(), 3.3) << trouble;
  }
}

TEST(Flights, OtherVehiclesFlyToo) {
  for (const char* model : {"momav-bench", "fixed-tilt-hexa"}) {
    const Flight flight = fly_mission("position-sweep", {std::string("vehicle.model=") + model});
    expect_no_failure(flight);
    EXPECT_LE(flight.result.statistics.position_error.mean(), 6.6e-3) << model;
  }
}

TEST(Flights, IdaConfirmsTheOneStepMethod) {
  for (const char* mission : {"figure-eight", "rotor-failure"}) {
    const Overrides short_one{"simulation.duration=4", "simulation.rtol=1e-8"};
    const Flight one = fly_mission(mission, short_one), other = fly_mission(mission, short_one, "ida");
    ASSERT_EQ(one.samples.size(), other.samples.size()) << other.result.explanation;
    for (std::size_t k = 0; k < one.samples.size(); ++k) {
      ASSERT_LE((one.samples[k].x - other.samples[k].x).lpNorm<Eigen::Infinity>(), 1e-4) << mission << ", t = " << one.samples[k].t;
    }
  }
}

TEST(Flights, TheSameSeedFliesTheSameFlight) {
  const Overrides windy{"wind.deviation=1", "sensors.drop_out=0.1", "simulation.duration=2"};
  const Flight one = fly_mission("figure-eight", windy), same = fly_mission("figure-eight", windy);
  EXPECT_EQ(one.samples.back().x, same.samples.back().x);
  Mission other = load_mission("figure-eight", windy);
  other.seed = 2;
  EXPECT_NE(fly(FlightDae(other, allocator_maker())).state.x, one.samples.back().x);
}

TEST(Flights, AFlightGoesOnFromACopyOfItsState) {
  const FlightDae dae(load_mission("servo-failure"), allocator_maker());
  DaeState state = initial_state_of(dae), copy;
  const auto first = make_integrator("dop853", dae), second = make_integrator("dop853", dae);
  first->advance(state, 3);
  copy = state;
  first->advance(state, 5);
  second->advance(copy, 5);  // another allocator, which is told of the stuck servo
  EXPECT_LE((state.x.head(13) - copy.x.head(13)).lpNorm<Eigen::Infinity>(), 1e-3);
}

TEST(Flights, TheAttitudeStaysAUnitQuaternion) {
  const Flight flight = fly_mission("tumble");
  for (const Sample& s : flight.samples) ASSERT_NEAR(s.x.segment<4>(3).norm(), 1, 1e-12);
}

}  // namespace
}  // namespace tenon::flight
