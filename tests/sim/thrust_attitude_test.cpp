#include "skyhalo/sim/thrust_attitude.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ThrustAttitudeTest, IsLevelInAHover) {
  const Eigen::AngleAxisd yaw(0.7, Eigen::Vector3d::UnitZ());
  EXPECT_LE((thrust_attitude({0, 0, 0}, 0.7) - yaw.toRotationMatrix()).norm(), 1e-15);
  EXPECT_LE((thrust_attitude({0, 0, 5}, 0.7) - yaw.toRotationMatrix()).norm(), 1e-15);
}

// Ahead with g: 45 degrees nose down, x to (1, 0, -1) / sqrt(2).
TEST(ThrustAttitudeTest, DipsTheNoseToSpeedUp) {
  const Eigen::Matrix3d R = thrust_attitude({kGravityMps2, 0, 0}, 0.0);
  const double half = 1.0 / std::numbers::sqrt2;
  EXPECT_LE((R.col(0) - Eigen::Vector3d(half, 0, -half)).norm(), 1e-12);
  EXPECT_LE((R.col(1) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_LE((R.col(2) - Eigen::Vector3d(half, 0, half)).norm(), 1e-12);
}

// To the left with g: 45 degrees about -x, the left side down.
TEST(ThrustAttitudeTest, LowersTheSideThatItSpeedsUpTo) {
  const Eigen::Matrix3d R = thrust_attitude({0, kGravityMps2, 0}, 0.0);
  const Eigen::AngleAxisd roll(-0.25 * kPi, Eigen::Vector3d::UnitX());
  EXPECT_LE((R - roll.toRotationMatrix()).norm(), 1e-12);
}

TEST(ThrustAttitudeProperty, NeverFlips) {
  std::mt19937 random(5);
  std::normal_distribution<double> spread(0.0, 30.0);
  for (int i = 0; i < 1000; ++i) {
    const double x = spread(random);
    const double y = spread(random);
    const Eigen::Matrix3d R = thrust_attitude({x, y, spread(random)}, spread(random));
    ASSERT_TRUE(is_rotation(R, 1e-12));
    ASSERT_GE(R(2, 2), std::cos(80.0 / 180.0 * kPi) - 1e-9);
  }
  EXPECT_LE((thrust_attitude({0, 0, -20}, 0.0) - Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

TEST(ThrustAttitudeTest, KeepsTheHeadingWhileSlow) {
  std::vector<Eigen::Vector3d> velocities;
  velocities.insert(velocities.end(), 100, {0.0, 0.1, 0.0});
  velocities.insert(velocities.end(), 100, {0.0, -1.0, 3.0});
  velocities.insert(velocities.end(), 100, {0.19, 0.0, 0.0});
  for (const double yaw : yaw_along_motion(velocities, 0.01, 1.0)) {
    EXPECT_NEAR(yaw, -0.5 * kPi, 1e-12);
  }
}

TEST(ThrustAttitudeTest, HasNoYawWithoutAHeading) {
  const std::vector<Eigen::Vector3d> velocities(50, {0.0, 0.0, 2.0});
  for (const double yaw : yaw_along_motion(velocities, 0.01, 1.0)) {
    EXPECT_EQ(yaw, 0.0);
  }
}

// A turn by 90 degrees at once takes pi/2 s with 1 rad/s, to which the smoothing adds 0.3 s.
TEST(ThrustAttitudeTest, TurnsNoFasterThanItsLimit) {
  std::vector<Eigen::Vector3d> velocities(100, {1.0, 0.0, 0.0});
  velocities.insert(velocities.end(), 300, {0.0, 1.0, 0.0});
  const std::vector<double> yaws = yaw_along_motion(velocities, 0.01, 1.0);
  for (std::size_t i = 1; i < yaws.size(); ++i) {
    EXPECT_GE(yaws[i] - yaws[i - 1], -1e-12);
    EXPECT_LE(yaws[i] - yaws[i - 1], 0.01 + 1e-12);
  }
  EXPECT_NEAR(yaws[69], 0.0, 1e-12);
  EXPECT_NEAR(yaws[100 + 78], 0.25 * kPi, 0.011);
  EXPECT_NEAR(yaws[100 + 158 + 30], 0.5 * kPi, 1e-12);
}

// Two turns to the left in 20 s: the yaw goes on over pi. At the end, behind which it stays, the
// Gaussian takes 0.1 s / sqrt(2 pi) of the rate off.
TEST(ThrustAttitudeTest, GoesOnOverFullTurns) {
  std::vector<Eigen::Vector3d> velocities;
  for (int i = 0; i <= 2000; ++i) {
    const double angle = 4.0 * kPi * i / 2000.0;
    velocities.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  const std::vector<double> yaws = yaw_along_motion(velocities, 0.01, 1.0);
  EXPECT_NEAR(yaws[1000], 2.0 * kPi, 1e-9);
  EXPECT_NEAR(yaws[2000], 4.0 * kPi - 0.2 * kPi * 0.1 / std::sqrt(2.0 * kPi), 1e-3);
}

}  // namespace
}  // namespace skyhalo
