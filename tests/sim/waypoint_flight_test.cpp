#include "skyhalo/sim/waypoint_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sim/motion_checks.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::extremes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::MotionExtremes;
using testing::nearest_m;
using testing::random_waypoints;

struct LimitsCase {
  FlightLimits limits;
  bool is_closed = false;
};

const std::array<LimitsCase, 4> kCases = {{
    {.limits = {}, .is_closed = false},
    {.limits = {}, .is_closed = true},
    {.limits = {.speed_mps = 12.0, .acceleration_mps2 = 9.0, .yaw_rate_radps = 3.0},
     .is_closed = false},
    {.limits = {.speed_mps = 1.0, .acceleration_mps2 = 0.5, .yaw_rate_radps = 0.5},
     .is_closed = true},
}};

TEST(WaypointFlightProperty, HoldsLimitsOnRandomWaypoints) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    for (const LimitsCase& test : kCases) {
      const auto waypoints = random_waypoints(seed, 3 + static_cast<int>(seed % 6));
      const MotionExtremes found =
          extremes_of(fly_waypoints(waypoints, test.limits, test.is_closed));
      SCOPED_TRACE("seed " + std::to_string(seed));
      EXPECT_LE(found.speed_mps, test.limits.speed_mps * (1.0 + 1e-6));
      EXPECT_LE(found.acceleration_mps2, test.limits.acceleration_mps2 * 1.02);
      EXPECT_LE(found.tilt_rad,
                std::asin(std::min(1.0, 1.02 * test.limits.acceleration_mps2 / kGravityMps2)));
    }
  }
}

TEST(WaypointFlightProperty, HoldsLimitsWhereWaypointsAreCloseOrTurnBack) {
  for (std::uint32_t seed = 100; seed < 120; ++seed) {
    auto close = random_waypoints(seed, 6);
    auto lattice = close;
    for (std::size_t i = 0; i < close.size(); ++i) {
      close[i] *= 0.05;
      lattice[i] = {
          5.0 * std::round(lattice[i].x() / 5.0), 10.0 * std::round(lattice[i].y() / 10.0), 0};
    }
    for (const LimitsCase& test : kCases) {
      for (const auto& waypoints : {close, lattice}) {
        const MotionExtremes found =
            extremes_of(fly_waypoints(waypoints, test.limits, test.is_closed));
        SCOPED_TRACE("seed " + std::to_string(seed));
        EXPECT_LE(found.speed_mps, test.limits.speed_mps);
        EXPECT_LE(found.acceleration_mps2, test.limits.acceleration_mps2 * 1.02);
      }
    }
  }
}

TEST(WaypointFlightProperty, UsesItsLimits) {
  const MotionExtremes found = extremes_of(fly_waypoints({{0, 0, 1}, {30, 0, 1}}, {}, false));
  EXPECT_GE(found.speed_mps, 4.0 * 0.99);
  EXPECT_GE(found.acceleration_mps2, 3.0 * 0.97);
}

TEST(WaypointFlightProperty, MovesSmoothly) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    for (const LimitsCase& test : kCases) {
      const auto waypoints = random_waypoints(seed, 6);
      const MotionExtremes found =
          extremes_of(fly_waypoints(waypoints, test.limits, test.is_closed));
      SCOPED_TRACE("seed " + std::to_string(seed));
      // A change of the acceleration from one side to the other through a Gaussian of 0.1 s is
      // no faster than 2 a / (0.1 s sqrt(2 pi)).
      const double most_jerk = 2.0 * test.limits.acceleration_mps2 / (0.1 * 2.5066);
      EXPECT_LE(found.acceleration_step_mps2, 0.005 * most_jerk * 1.1);
      // Velocity is the positions' derivative: a difference over 5 ms is off by jerk * h^2 / 24.
      EXPECT_LE(found.velocity_error_mps, most_jerk * 0.005 * 0.005 / 24.0 * 1.1);
    }
  }
}

TEST(WaypointFlightProperty, PassesEachWaypointWithinTheSmoothing) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    for (const LimitsCase& test : kCases) {
      const auto waypoints = random_waypoints(seed, 6);
      const Trajectory flight = fly_waypoints(waypoints, test.limits, test.is_closed);
      for (const Eigen::Vector3d& waypoint : waypoints) {
        EXPECT_LE(nearest_m(flight, waypoint), 0.005 * test.limits.acceleration_mps2 + 1e-3);
      }
    }
  }
}

TEST(WaypointFlightTest, BeginsAndEndsAtRestAtTheEnds) {
  const std::vector<Eigen::Vector3d> waypoints = {{0, 0, 1}, {5, 0, 1}, {5, 5, 2}};
  for (const bool is_closed : {false, true}) {
    const Trajectory flight = fly_waypoints(waypoints, {}, is_closed);
    const Eigen::Vector3d end = is_closed ? waypoints.front() : waypoints.back();
    EXPECT_LE((flight.T_map_body(0.0).translation() - waypoints.front()).norm(), 1e-3);
    EXPECT_LE((flight.T_map_body(1e9).translation() - end).norm(), 1e-3);
    EXPECT_LE(flight.velocity_mps(0.0).norm(), 1e-6);
    EXPECT_LE(flight.velocity_mps(flight.duration_s()).norm(), 1e-6);
    EXPECT_LE(flight.acceleration_mps2(0.0).norm(), 0.1);
    EXPECT_LE(flight.acceleration_mps2(flight.duration_s()).norm(), 0.1);
  }
}

// 30 m with 4 m/s and 3 m/s^2: 4/3 s to speed up over 8/3 m, 74/3 m in 37/6 s, 4/3 s to slow down;
// 8.83 s, and 0.3 s for the smoothing at each end.
TEST(WaypointFlightTest, TakesTheTimeOfATrapezoid) {
  const Trajectory flight = fly_waypoints({{0, 0, 1}, {30, 0, 1}}, {}, false);
  EXPECT_NEAR(flight.duration_s(), 8.0 / 3.0 + 37.0 / 6.0 + 0.6, 0.08);
  const Pose middle = flight.T_map_body(0.5 * flight.duration_s());
  EXPECT_NEAR(middle.translation().x(), 15.0, 0.02);
  EXPECT_LE((middle.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
}

TEST(WaypointFlightTest, DipsItsNoseToSpeedUpAndRaisesItToSlowDown) {
  const Trajectory flight = fly_waypoints({{0, 0, 1}, {0, 30, 1}}, {}, false);
  const double pitch = std::atan(0.985 * 3.0 / kGravityMps2);
  const auto rotation = [&](double t_s) -> Eigen::Matrix3d {
    return flight.T_map_body(t_s).linear();
  };
  const Eigen::AngleAxisd left(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd down(pitch, Eigen::Vector3d::UnitY());
  EXPECT_LE((rotation(1.0) - (left * down).toRotationMatrix()).norm(), 1e-3);
  EXPECT_LE(
      (rotation(flight.duration_s() - 1.0) - (left * down.inverse()).toRotationMatrix()).norm(),
      1e-3);
}

TEST(WaypointFlightTest, StopsWhereItTurnsBackAndTurnsWithinTheYawRate) {
  const FlightLimits limits = {.speed_mps = 4.0, .acceleration_mps2 = 3.0, .yaw_rate_radps = 1.0};
  const Trajectory flight = fly_waypoints({{0, 0, 1}, {10, 0, 1}, {0, 0, 1}}, limits, false);
  const MotionExtremes found = extremes_of(flight);
  EXPECT_LE(found.acceleration_mps2, 3.0 * 1.02);
  EXPECT_LE(nearest_m(flight, {10, 0, 1}), 0.016);
  EXPECT_LE((flight.T_map_body(1e9).linear().col(0) + Eigen::Vector3d::UnitX()).norm(), 0.2);
  double last = 0.0;
  for (int i = 0; 0.01 * i < flight.duration_s(); ++i) {
    const Eigen::Vector3d across = flight.T_map_body(0.01 * i).linear().col(1);
    const double yaw = std::atan2(-across.x(), across.y());
    EXPECT_LE(std::abs(std::remainder(yaw - last, 2.0 * std::numbers::pi)), 0.01 * 1.001);
    last = yaw;
  }
}

TEST(WaypointFlightTest, ClimbsStraightWithoutAHeading) {
  const Trajectory flight = fly_waypoints({{1, 2, 0}, {1, 2, 8}}, {}, false);
  for (const double t_s : {0.0, 1.0, 2.0, 3.0}) {
    EXPECT_LE((flight.T_map_body(t_s).linear() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
}

TEST(WaypointFlightTest, MergesRepeatedWaypoints) {
  const std::vector<Eigen::Vector3d> once = {{0, 0, 1}, {5, 0, 1}, {5, 5, 2}};
  const std::vector<Eigen::Vector3d> twice = {
      {0, 0, 1}, {0, 0, 1}, {5, 0, 1}, {5, 0, 1}, {5, 5, 2}, {5, 5, 2}};
  const Trajectory a = fly_waypoints(once, {}, false);
  const Trajectory b = fly_waypoints(twice, {}, false);
  EXPECT_EQ(a.duration_s(), b.duration_s());
  EXPECT_EQ(a.T_map_body(2.5).matrix(), b.T_map_body(2.5).matrix());
}

TEST(WaypointFlightTest, GivesTheSameBitsAgain) {
  const auto waypoints = random_waypoints(7, 8);
  const Trajectory a = fly_waypoints(waypoints, {}, true);
  const Trajectory b = fly_waypoints(waypoints, {}, true);
  ASSERT_EQ(a.samples().size(), b.samples().size());
  for (std::size_t i = 0; i < a.samples().size(); ++i) {
    ASSERT_EQ(a.samples()[i].T_map_body.matrix(), b.samples()[i].T_map_body.matrix());
    ASSERT_EQ(a.samples()[i].velocity_mps, b.samples()[i].velocity_mps);
  }
}

TEST(WaypointFlightTest, RefusesWaypointsThatMakeNoPath) {
  const auto message = [](const std::vector<Eigen::Vector3d>& waypoints, bool is_closed) {
    return message_of([&] { (void)fly_waypoints(waypoints, {}, is_closed); });
  };
  EXPECT_THAT(message({}, false), HasSubstr("found 0 waypoints that differ"));
  EXPECT_THAT(message({{1, 2, 3}}, true), HasSubstr("found 1 waypoints that differ"));
  EXPECT_THAT(message({{1, 2, 3}, {1, 2, 3}}, true), HasSubstr("found 1 waypoints that differ"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({{1, 2, 3}, {1, nan, 3}}, false), HasSubstr("waypoint 2"));
  EXPECT_THAT(message({{1, 2, 3}, {2e6, 0, 3}}, false), HasSubstr("waypoint 2"));
  EXPECT_THAT(message({{0, 0, 0}, {30'000, 0, 0}}, false), HasSubstr("path of 30000 m"));
}

TEST(WaypointFlightTest, RefusesLimitsOutOfTheirRange) {
  const auto message = [](const FlightLimits& limits) {
    return message_of([&] { (void)fly_waypoints({{0, 0, 0}, {1, 0, 0}}, limits, false); });
  };
  EXPECT_THAT(message({.speed_mps = 0.0}), AllOf(HasSubstr("speed_mps is 0"), HasSubstr("0.05")));
  EXPECT_THAT(message({.acceleration_mps2 = 9.9}), HasSubstr("acceleration_mps2 is 9.9"));
  EXPECT_THAT(message({.yaw_rate_radps = std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("yaw_rate_radps is nan"));
  const FlightLimits slow = {.speed_mps = 0.05, .acceleration_mps2 = 1.0, .yaw_rate_radps = 1.0};
  EXPECT_THAT(message_of([&] {
                (void)fly_waypoints({{0, 0, 0}, {500, 0, 0}}, slow, false);
              }),
              HasSubstr("expected at most 3600"));
}

}  // namespace
}  // namespace skyhalo
