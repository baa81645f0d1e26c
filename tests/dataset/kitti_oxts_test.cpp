#include "skyhalo/dataset/kitti_oxts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "reference/naive_pinhole.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr double kPi = 3.14159265358979323846;

/// A line of `count` numbers: the first six given, the others zero.
std::string line_of(const std::string& first_six, int count = 30) {
  std::string line = first_six;
  for (int i = 6; i < count; ++i) {
    line += " 0";
  }
  return line;
}

TEST(KittiOxtsTest, ReadsTheFirstSixNumbers) {
  const TempFolder folder;
  const auto file = folder.write(
      "0000000000.txt", line_of("49.015 8.434 116.5 0.03 -0.02 -1.25") + "\nsecond line\n");
  const InsReading reading = read_oxts(file);
  EXPECT_EQ(reading.latitude_deg, 49.015);
  EXPECT_EQ(reading.longitude_deg, 8.434);
  EXPECT_EQ(reading.altitude_m, 116.5);
  EXPECT_EQ(reading.roll_rad, 0.03);
  EXPECT_EQ(reading.pitch_rad, -0.02);
  EXPECT_EQ(reading.yaw_rad, -1.25);
}

TEST(KittiOxtsTest, AnythingButThirtyFiniteNumbersIsRefused) {
  const TempFolder folder;
  const std::string six = "49.0 8.4 116.5 0 0 0";
  for (const std::string& bad : {std::string(),
                                 std::string("\n"),
                                 six,
                                 line_of(six, 29),
                                 line_of(six, 31),
                                 line_of("49.0 8.4 116.5 0 0 nan"),
                                 line_of("49.0 8.4 inf 0 0 0"),
                                 line_of("49.0 8,4 116.5 0 0 0"),
                                 line_of(six, 29) + " x",
                                 line_of("90.5 8.4 116.5 0 0 0"),
                                 line_of("-91 8.4 116.5 0 0 0")}) {
    SCOPED_TRACE(bad);
    const auto file = folder.write("0000000003.txt", bad);
    EXPECT_THAT(message_of([&] { (void)read_oxts(file); }), HasSubstr(file.string() + ":1:"));
  }
}

TEST(KittiOxtsTest, AMissingFileIsNamed) {
  const TempFolder folder;
  const auto file = folder.path() / "0000000000.txt";
  EXPECT_THAT(message_of([&] { (void)read_oxts(file); }), HasSubstr(file.string()));
}

TEST(KittiOxtsTest, ADegreeOfLongitudeAtTheEquator) {
  // pi / 180 * 6378137 m = 111 319.490793 m.
  const Pose T = T_enu_body({.longitude_deg = 1.0, .altitude_m = 7.0}, 0.0);
  EXPECT_NEAR(T.translation().x(), 111319.490793, 1e-5);
  EXPECT_NEAR(T.translation().y(), 0.0, 1e-8);
  EXPECT_EQ(T.translation().z(), 7.0);
  EXPECT_TRUE(T.linear().isIdentity(1e-15));
}

TEST(KittiOxtsTest, AtSixtyDegreesADegreeOfLongitudeIsHalfAsLong) {
  const Pose T = T_enu_body({.latitude_deg = 60.0, .longitude_deg = 1.0}, 60.0);
  EXPECT_NEAR(T.translation().x(), 0.5 * 111319.490793, 1e-5);
}

TEST(KittiOxtsTest, NorthIsY) {
  // Near the first latitude a degree of latitude is as long as on a sphere: 0.001 deg = 111.319 m.
  const Pose a = T_enu_body({.latitude_deg = 49.0}, 49.0);
  const Pose b = T_enu_body({.latitude_deg = 49.001}, 49.0);
  EXPECT_NEAR((b.translation() - a.translation()).y(), 111.319, 0.01);
}

TEST(KittiOxtsTest, YawTurnsToTheLeftFromEast) {
  const Pose T = T_enu_body({.yaw_rad = kPi / 2.0}, 0.0);
  EXPECT_LT((T.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(KittiOxtsTest, RollComesFirstThenPitchThenYaw) {
  // Ry(90 deg) takes (x, y, z) to (z, y, -x); Rx(90 deg) takes it to (x, -z, y): left (0, 1, 0)
  // becomes up (0, 0, 1) by the roll, ahead (1, 0, 0) by the pitch, and left again by a yaw of 90
  // deg.
  const Pose T =
      T_enu_body({.roll_rad = kPi / 2.0, .pitch_rad = kPi / 2.0, .yaw_rad = kPi / 2.0}, 0.0);
  EXPECT_LT((T.linear() * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  // Ahead stays ahead by the roll, goes down by the pitch and stays there.
  EXPECT_LT((T.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

Pose naive_pose(const reference::NaiveOxts& oxts, double first_latitude_deg) {
  const reference::NaiveMatrix4 naive = reference::naive_pose_from_oxts(oxts, first_latitude_deg);
  Pose T = Pose::Identity();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      T.matrix()(row, column) =
          naive.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column));
    }
  }
  return T;
}

TEST(KittiOxtsReference, RelativePosesAreThoseOfTheReference) {
  std::mt19937 random(14);
  std::uniform_real_distribution step_deg(-0.002, 0.002);  // some 200 m
  std::uniform_real_distribution angle(-kPi, kPi);
  std::uniform_real_distribution latitude(-70.0, 70.0);
  for (int round = 0; round < 200; ++round) {
    const reference::NaiveOxts first{
        latitude(random), angle(random), 100.0, angle(random), angle(random), angle(random)};
    const reference::NaiveOxts later{first.lat_deg + step_deg(random),
                                     first.lon_deg + step_deg(random),
                                     103.0,
                                     angle(random),
                                     angle(random),
                                     angle(random)};
    const auto pose = [&](const reference::NaiveOxts& o) {
      return T_enu_body({o.lat_deg, o.lon_deg, o.alt_m, o.roll_rad, o.pitch_rad, o.yaw_rad},
                        first.lat_deg);
    };
    const Pose actual = pose(first).inverse() * pose(later);
    const Pose expected =
        naive_pose(first, first.lat_deg).inverse() * naive_pose(later, first.lat_deg);
    EXPECT_LT((actual.translation() - expected.translation()).norm(), 1e-6);
    EXPECT_LT((actual.linear() - expected.linear()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace skyhalo
