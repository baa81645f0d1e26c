#include "skyhalo/sim/speed_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace skyhalo {
namespace {

FlightPath circle_path(double radius_m, int points) {
  std::vector<Eigen::Vector3d> circle;
  for (int i = 0; i <= points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / points;
    circle.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0);
  }
  return path_along(circle);
}

// From rest over 1 m with 2 m/s^2: v = sqrt(2 * 2 * 1) = 2 m/s after 1 s.
TEST(SpeedProfileTest, SpeedsUpFromRestAndSlowsDownToIt) {
  const FlightPath path = path_along({{0, 0, 0}, {1, 0, 0}, {9, 0, 0}, {10, 0, 0}});
  const auto speeds =
      fastest_speeds(path, {.speed_mps = 10.0, .acceleration_mps2 = 2.0, .yaw_rate_radps = 1.0});
  EXPECT_EQ(speeds[0], 0.0);
  EXPECT_DOUBLE_EQ(speeds[1], 2.0);
  EXPECT_DOUBLE_EQ(speeds[2], 2.0);
  EXPECT_EQ(speeds[3], 0.0);
  const auto times = times_at(path, speeds);
  EXPECT_DOUBLE_EQ(times[1], 1.0);
  EXPECT_DOUBLE_EQ(times[2], 5.0);
  EXPECT_DOUBLE_EQ(times[3], 6.0);
}

// 3 m/s^2 across a circle of 1.5 m: sqrt(4.5) m/s in the middle, whatever the limit.
TEST(SpeedProfileTest, SlowsDownForABend) {
  const FlightPath path = circle_path(1.5, 2000);
  const auto speeds =
      fastest_speeds(path, {.speed_mps = 8.0, .acceleration_mps2 = 3.0, .yaw_rate_radps = 1.0});
  EXPECT_NEAR(*std::max_element(speeds.begin(), speeds.end()), std::sqrt(4.5), 1e-3);
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) {
    const double along =
        (speeds[i + 1] * speeds[i + 1] - speeds[i] * speeds[i]) / (2.0 * path.lengths_m[i]);
    const double across = std::max(speeds[i] * speeds[i], speeds[i + 1] * speeds[i + 1]) / 1.5;
    EXPECT_LE(std::hypot(along, across), 3.0 * 1.005);
  }
}

TEST(SpeedProfileTest, StopsAtACorner) {
  const FlightPath path = path_along({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}});
  EXPECT_TRUE(path.is_corner(2));
  EXPECT_FALSE(path.is_corner(1));
  const auto speeds = fastest_speeds(path, {});
  EXPECT_LE(speeds[2], 0.005);
  EXPECT_GT(speeds[1], 1.0);
}

}  // namespace
}  // namespace skyhalo
