#include "skyhalo/sim/flight_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "sim/motion_checks.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::extremes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::MotionExtremes;
using testing::random_waypoints;

TEST(FlightPlanTest, NamesItsKinds) {
  EXPECT_EQ(flight_kind("route"), FlightKind::kWaypoints);
  EXPECT_EQ(flight_kind("hover"), FlightKind::kHover);
  EXPECT_EQ(flight_kind("orbit"), FlightKind::kOrbit);
  EXPECT_EQ(flight_kind("aggressive"), FlightKind::kAggressive);
  EXPECT_EQ(flight_kind("Hover"), std::nullopt);
  EXPECT_EQ(flight_kind(""), std::nullopt);
}

TEST(FlightPlanProperty, HoversLevelAboutItsPoint) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const HoverSettings settings = {.position_m = {3, -2, 5}, .yaw_rad = 1.0, .seed = seed};
    const Trajectory flight = fly_hover(settings);
    const MotionExtremes found = extremes_of(flight);
    EXPECT_DOUBLE_EQ(flight.duration_s(), 20.0);
    EXPECT_LE(found.tilt_rad, 0.026);
    EXPECT_GE(found.tilt_rad, 0.005);
    // Each axis is at most 0.04 m / sqrt(3) times sums of the greatest rates, 2 pi 0.26 Hz.
    EXPECT_LE(found.speed_mps, 0.04 * 2.0 * std::numbers::pi * (0.075 + 0.09 + 0.12));
    EXPECT_LE(found.acceleration_mps2, 0.6);
    double furthest = 0.0;
    for (int i = 0; i < 400; ++i) {
      const Pose T = flight.T_map_body(0.05 * i);
      furthest = std::max(furthest, (T.translation() - settings.position_m).norm());
      EXPECT_NEAR(std::atan2(T.linear()(1, 0), T.linear()(0, 0)), 1.0, 0.0265);
    }
    EXPECT_LE(furthest, 0.04);
    EXPECT_GE(furthest, 0.01);
  }
}

TEST(FlightPlanTest, HoversBySeed) {
  HoverSettings settings;
  const Trajectory a = fly_hover(settings);
  const Trajectory same = fly_hover(settings);
  settings.seed = 2;
  const Trajectory other = fly_hover(settings);
  EXPECT_EQ(a.T_map_body(7.123).matrix(), same.T_map_body(7.123).matrix());
  EXPECT_NE(a.T_map_body(7.123).matrix(), other.T_map_body(7.123).matrix());
}

TEST(FlightPlanTest, HoversStillWithoutWanderAndSway) {
  const Trajectory flight = fly_hover({.position_m = {1, 2, 3}, .wander_m = 0.0, .sway_rad = 0.0});
  EXPECT_LE(
      (flight.T_map_body(5.0).matrix() - make_pose(Eigen::Matrix3d::Identity(), {1, 2, 3}).matrix())
          .norm(),
      1e-12);
}

// 6 m/s on 9 m: 4 m/s^2 towards the centre, on the left of the motion; the left side is down,
// the thrust leans to the left.
TEST(FlightPlanTest, BanksTowardsTheCentreOfAnOrbit) {
  for (const bool is_clockwise : {false, true}) {
    const OrbitSettings settings = {
        .centre_m = {1, 2, 10}, .radius_m = 9.0, .speed_mps = 6.0, .is_clockwise = is_clockwise};
    const Trajectory flight = fly_orbit(settings);
    const double bank = std::atan(4.0 / kGravityMps2);
    EXPECT_NEAR(flight.duration_s(), 2.0 * std::numbers::pi * 9.0 / 6.0, 1e-9);
    for (const double t_s : {0.0, 1.234, 5.0, flight.duration_s()}) {
      const Pose T = flight.T_map_body(t_s);
      const Eigen::Vector3d inwards = (settings.centre_m - T.translation()) / 9.0;
      EXPECT_NEAR(inwards.norm(), 1.0, 1e-6);
      EXPECT_LE(
          (T.linear().col(2) - std::sin(bank) * inwards - std::cos(bank) * Eigen::Vector3d::UnitZ())
              .norm(),
          1e-5);
      EXPECT_LE((T.linear().col(0) - flight.velocity_mps(t_s) / 6.0).norm(), 1e-4);
      EXPECT_LE((flight.acceleration_mps2(t_s) - 4.0 * inwards).norm(), 0.02);
    }
    EXPECT_LE((flight.T_map_body(0.0).translation() - Eigen::Vector3d(10, 2, 10)).norm(), 1e-12);
    EXPECT_EQ(flight.T_map_body(1.0).translation().y() > 2.0, !is_clockwise);
  }
}

TEST(FlightPlanTest, LooksAtTheCentreOfAnOrbit) {
  const Trajectory flight =
      fly_orbit({.radius_m = 5.0, .speed_mps = 2.0, .turns = 1.5, .yaw = OrbitYaw::kTowardsCentre});
  const double pitch = std::atan(4.0 / 5.0 / kGravityMps2);
  for (const double t_s : {0.0, 3.3, 20.0}) {
    const Pose T = flight.T_map_body(t_s);
    const Eigen::Vector3d inwards = -T.translation() / 5.0;
    EXPECT_LE(
        (T.linear().col(0) - std::cos(pitch) * inwards + std::sin(pitch) * Eigen::Vector3d::UnitZ())
            .norm(),
        1e-4);
  }
  EXPECT_LE((flight.T_map_body(1e9).translation() - Eigen::Vector3d(-5, 0, 0)).norm(), 1e-9);
}

TEST(FlightPlanProperty, FliesAggressivelyFasterThanOtherwise) {
  FlightPlan plan = {.waypoints_m = random_waypoints(3, 7), .is_closed = true};
  const Trajectory calm = fly(plan);
  plan.kind = FlightKind::kAggressive;
  const Trajectory aggressive = fly(plan);
  EXPECT_LT(aggressive.duration_s(), 0.75 * calm.duration_s());
  EXPECT_GT(extremes_of(aggressive).tilt_rad, 0.6);
  EXPECT_LE(extremes_of(aggressive).speed_mps, 12.0);
  EXPECT_LE(extremes_of(calm).tilt_rad, 0.32);
}

TEST(FlightPlanTest, FliesThePlansKind) {
  FlightPlan plan = {.waypoints_m = {{0, 0, 1}, {5, 0, 1}}};
  plan.hover.position_m = {7, 7, 7};
  plan.orbit.centre_m = {50, 0, 0};
  EXPECT_NEAR(fly(plan).T_map_body(1e9).translation().x(), 5.0, 1e-3);
  plan.kind = FlightKind::kHover;
  EXPECT_NEAR(fly(plan).T_map_body(1.0).translation().y(), 7.0, 0.05);
  plan.kind = FlightKind::kOrbit;
  EXPECT_NEAR(fly(plan).T_map_body(0.0).translation().x(), 55.0, 1e-9);
}

TEST(FlightPlanTest, RefusesSettingsOutOfTheirRange) {
  const auto hover = [](const HoverSettings& settings) {
    return message_of([&] { (void)fly_hover(settings); });
  };
  const auto orbit = [](const OrbitSettings& settings) {
    return message_of([&] { (void)fly_orbit(settings); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(hover({.duration_s = 0.0}), HasSubstr("duration_s is 0, expected 0.1 to 3600"));
  EXPECT_THAT(hover({.wander_m = -0.1}), HasSubstr("wander_m is -0.1"));
  EXPECT_THAT(hover({.sway_rad = nan}), HasSubstr("sway_rad is nan"));
  EXPECT_THAT(hover({.position_m = {0, nan, 0}}), HasSubstr("coordinate"));
  EXPECT_THAT(orbit({.radius_m = 0.0}), HasSubstr("radius_m is 0"));
  EXPECT_THAT(orbit({.speed_mps = 0.0}), HasSubstr("speed_mps is 0"));
  EXPECT_THAT(orbit({.turns = -1.0}), HasSubstr("turns is -1"));
  EXPECT_THAT(orbit({.radius_m = 2.0, .speed_mps = 8.0}), HasSubstr("radius_m is 32"));
  EXPECT_THAT(orbit({.turns = 1000.0}), HasSubstr("expected at most 3600"));
}

}  // namespace
}  // namespace skyhalo
