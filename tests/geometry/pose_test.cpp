#include "skyhalo/geometry/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace skyhalo {
namespace {

Eigen::Matrix3d quarter_turn_left() {
  Eigen::Matrix3d R;
  R << 0, -1, 0,  //
      1, 0, 0,    //
      0, 0, 1;
  return R;
}

TEST(PoseTest, TakesBodyCoordinatesToTheMap) {
  // The vehicle stands at (10, 20, 30) and looks along the map's y: one metre ahead of it is y + 1,
  // two to its left is x - 2.
  const Pose T_map_body = make_pose(quarter_turn_left(), {10.0, 20.0, 30.0});
  const Eigen::Vector3d p_map = T_map_body * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_EQ(p_map, Eigen::Vector3d(8.0, 21.0, 33.0));
}

TEST(PoseTest, InverseGoesBack) {
  const Pose T_map_body = make_pose(quarter_turn_left(), {10.0, 20.0, 30.0});
  const Eigen::Vector3d p_body = T_map_body.inverse() * Eigen::Vector3d(8.0, 21.0, 33.0);
  EXPECT_TRUE(p_body.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-15));
}

TEST(PoseTest, KnowsARotation) {
  EXPECT_TRUE(is_rotation(Eigen::Matrix3d::Identity(), 0.0));
  EXPECT_TRUE(is_rotation(quarter_turn_left(), 0.0));
}

TEST(PoseTest, AReflectionIsNoRotation) {
  EXPECT_FALSE(is_rotation(Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal(), 1e-3));
  EXPECT_FALSE(is_rotation(-Eigen::Matrix3d::Identity(), 1e-3));
  Eigen::Matrix3d exchange;
  exchange << 0, 1, 0,  //
      1, 0, 0,          //
      0, 0, 1;
  EXPECT_FALSE(is_rotation(exchange, 1e-3));
}

TEST(PoseTest, AStretchedOrShearedMatrixIsNoRotation) {
  EXPECT_FALSE(is_rotation(2.0 * Eigen::Matrix3d::Identity(), 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Matrix3d::Zero(), 1e-3));
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.01;
  EXPECT_FALSE(is_rotation(shear, 1e-3));
}

TEST(PoseTest, TheToleranceIsOnTheEntriesOfRTimesRTransposed) {
  // Scaled by s: R R' - I = (s^2 - 1) I; s^2 = 1.002 lies between the two tolerances.
  const Eigen::Matrix3d scaled = std::sqrt(1.002) * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(is_rotation(scaled, 0.0021));
  EXPECT_FALSE(is_rotation(scaled, 0.0019));
}

TEST(PoseTest, NanIsNoRotation) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_rotation(R, 1.0));
  EXPECT_FALSE(
      is_rotation(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()), 1.0));
}

TEST(PoseProperty, RandomRotationsPassAndTheirReflectionsDoNot) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> component(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(component(random), component(random), 1.5 + component(random)).normalized();
    const double angle_rad = std::numbers::pi * component(random);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
    EXPECT_TRUE(is_rotation(R, 1e-12));
    EXPECT_FALSE(is_rotation(-R, 1e-12));
  }
}

}  // namespace
}  // namespace skyhalo
