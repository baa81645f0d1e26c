#include "skyhalo/sim/flight_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/motion_checks.hpp"

namespace skyhalo {
namespace {

using testing::random_waypoints;

bool has_point(const FlightPath& path, const Eigen::Vector3d& point_m) {
  for (const Eigen::Vector3d& candidate : path.points_m) {
    if ((candidate - point_m).norm() < 1e-9) {
      return true;
    }
  }
  return false;
}

TEST(FlightPathTest, IsStraightBetweenTwoWaypoints) {
  const FlightPath path = spline_path({{0, 0, 1}, {3, 4, 1}}, false);
  for (std::size_t i = 0; i < path.points_m.size(); ++i) {
    EXPECT_NEAR(path.points_m[i].y(), path.points_m[i].x() * 4.0 / 3.0, 1e-12);
    EXPECT_NEAR(path.curvatures_per_m[i], 0.0, 1e-6);
  }
  EXPECT_LE((path.tangents[10] - Eigen::Vector3d(0.6, 0.8, 0.0)).norm(), 1e-9);
}

TEST(FlightPathTest, MeasuresACircle) {
  std::vector<Eigen::Vector3d> circle;
  for (int i = 0; i <= 100; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 200.0;
    circle.emplace_back(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0);
  }
  const FlightPath path = path_along(circle);
  EXPECT_NEAR(path.curvatures_per_m[50], 0.5, 1e-4);
  EXPECT_LE((path.tangents[50] - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(path.point_m(50, 0.5).norm(), 2.0, 1e-6);
}

TEST(FlightPathProperty, GoesThroughItsWaypointsInSmallSteps) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const auto waypoints = random_waypoints(seed, 6);
    for (const bool is_closed : {false, true}) {
      const FlightPath path = spline_path(waypoints, is_closed);
      for (const Eigen::Vector3d& waypoint : waypoints) {
        EXPECT_TRUE(has_point(path, waypoint));
      }
      const Eigen::Vector3d end = is_closed ? waypoints.front() : waypoints.back();
      EXPECT_LE((path.points_m.back() - end).norm(), 1e-9);
      for (const double length_m : path.lengths_m) {
        EXPECT_GT(length_m, 0.0);
        EXPECT_LE(length_m, 0.06);
      }
    }
  }
}

TEST(FlightPathTest, CountsRepeatedPointsOnce) {
  const FlightPath path = path_along({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(path.points_m.size(), 2U);
  EXPECT_EQ(path.lengths_m, std::vector<double>{1.0});
  EXPECT_EQ(path.point_m(0, 0.25), Eigen::Vector3d(0.25, 0, 0));
}

}  // namespace
}  // namespace skyhalo
