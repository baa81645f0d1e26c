#include "skyhalo/dataset/euroc_poses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr const char* kRest = ",0,0,0,0,0,0,0,0,0\n";

std::vector<EurocPose> read(const std::string& text) {
  const TempFolder folder;
  return read_euroc_poses(folder.write("data.csv", text));
}

std::string complaint(const std::string& text) {
  return message_of([&] { (void)read(text); });
}

Timestamp at_ms(int ms) {
  return Timestamp(std::chrono::milliseconds(ms));
}

EurocPose pose(int ms, double x_m, double yaw_rad) {
  return {at_ms(ms),
          make_pose(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                    {x_m, 0.0, 0.0})};
}

double yaw_rad(const Pose& T) {
  return std::atan2(T.linear()(1, 0), T.linear()(0, 0));
}

TEST(EurocPosesTest, ReadsPositionAndQuaternion) {
  // A quarter turn about z: x of the IMU is y of the world.
  const auto poses = read(std::string("#t,...\n1403715273262142976,1.5,-2,0.25,") +
                          "0.70710678,0,0,0.70710678" + kRest);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].stamp.time_since_epoch().count(), 1403715273262142976);
  const Eigen::Vector3d p_world_m = poses[0].T_world_imu * Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_LT((p_world_m - Eigen::Vector3d(1.5, 0.0, 0.25)).norm(), 1e-7);
}

TEST(EurocPosesTest, QuaternionsAreNormalised) {
  const auto poses = read(std::string("1,0,0,0,1.005,0,0,0") + kRest);
  EXPECT_TRUE(poses[0].T_world_imu.linear().isIdentity(1e-12));
  EXPECT_TRUE(
      read(std::string("1,0,0,0,-1,0,0,0") + kRest)[0].T_world_imu.linear().isIdentity(1e-12));
}

TEST(EurocPosesTest, ALineThatCannotBeIsNamed) {
  const std::string good = std::string("1,0,0,0,1,0,0,0") + kRest;
  EXPECT_THAT(complaint(good + "2,0,0,0,0.9,0,0,0" + kRest), HasSubstr("data.csv:2: the quater"));
  EXPECT_THAT(complaint(good + "2,0,0,0,0,0,0,0" + kRest), HasSubstr("data.csv:2: the quater"));
  EXPECT_THAT(complaint(good + "2,0,0,0,1e200,1e200,0,0" + kRest), HasSubstr("data.csv:2: "));
  EXPECT_THAT(complaint(good + "2,0,nan,0,1,0,0,0" + kRest), HasSubstr("found 'nan'"));
  EXPECT_THAT(complaint(good + "2,0,,0,1,0,0,0" + kRest), HasSubstr("data.csv:2: "));
  EXPECT_THAT(complaint(good + "2,0,0,0,1,0,0,0\n"), HasSubstr("data.csv:2: expected"));
}

TEST(EurocPosesTest, BetweenTwoPosesItIsInProportion) {
  const std::vector<EurocPose> poses{pose(100, 1.0, 0.2), pose(200, 2.0, 0.6)};
  const auto quarter = T_world_imu(poses, at_ms(125));
  ASSERT_TRUE(quarter.has_value());
  EXPECT_NEAR(quarter->translation().x(), 1.25, 1e-12);
  EXPECT_NEAR(yaw_rad(*quarter), 0.3, 1e-12);
}

TEST(EurocPosesTest, TurnsTheShortWay) {
  // From 170 to 190 degrees, not back through 0.
  const double deg = std::numbers::pi / 180.0;
  const std::vector<EurocPose> poses{pose(0, 0.0, 170.0 * deg), pose(100, 0.0, 190.0 * deg)};
  EXPECT_NEAR(std::abs(yaw_rad(*T_world_imu(poses, at_ms(50)))), 180.0 * deg, 1e-9);
}

TEST(EurocPosesTest, APoseOfThatMomentIsTakenAsItIs) {
  const std::vector<EurocPose> poses{pose(0, 1.0, 0.0), pose(900, 2.0, 0.0), pose(2000, 3.0, 0.0)};
  EXPECT_EQ(T_world_imu(poses, at_ms(0))->translation().x(), 1.0);
  EXPECT_EQ(T_world_imu(poses, at_ms(900))->translation().x(), 2.0);
  EXPECT_EQ(T_world_imu(poses, at_ms(2000))->translation().x(), 3.0);
}

TEST(EurocPosesTest, ThereIsNoneOutsideAndInGaps) {
  const std::vector<EurocPose> poses{pose(0, 1.0, 0.0), pose(200, 2.0, 0.0), pose(401, 3.0, 0.0)};
  EXPECT_FALSE(T_world_imu(poses, at_ms(-1)).has_value());
  EXPECT_TRUE(T_world_imu(poses, at_ms(100)).has_value());
  EXPECT_FALSE(T_world_imu(poses, at_ms(300)).has_value());
  EXPECT_FALSE(T_world_imu(poses, at_ms(402)).has_value());
  EXPECT_FALSE(T_world_imu({}, at_ms(0)).has_value());
}

}  // namespace
}  // namespace skyhalo
