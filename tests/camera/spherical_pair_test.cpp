#include "skyhalo/camera/spherical_pair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A pixel is half a degree wide and a quarter high, principal point (180, 120), baseline 0.5 m.
SphericalPair example_pair() {
  return {.delta_theta_u_rad = 0.5 * kDegree,
          .delta_theta_v_rad = 0.25 * kDegree,
          .principal_u_px = 180.0,
          .principal_v_px = 120.0,
          .baseline_m = 0.5};
}

TEST(SphericalPairTest, AMatchStraightAhead) {
  // delta = 90 * 0.5 = 45 degrees: B/tan(45 degrees).
  EXPECT_LT((reproject(example_pair(), 180.0, 120.0, 90.0) - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(),
            1e-15);
}

TEST(SphericalPairTest, AMatchToTheLeft) {
  // alpha = -60 * 0.5 = -30 degrees, delta = 30 degrees: the left ray is straight ahead, so the
  // point is at x = -B, and z = B/tan(30 degrees); k = 0.5 * 1/0.5 = 1 m.
  EXPECT_LT((reproject(example_pair(), 120.0, 120.0, 60.0) -
             Eigen::Vector3d(-0.5, 0.0, 0.5 * std::sqrt(3.0)))
                .norm(),
            1e-15);
}

TEST(SphericalPairTest, AMatchToTheRightAndBelow) {
  // alpha 30, delta 30, beta 120 * 0.25 = 30 degrees: k = 0.5 cos(60)/sin(30) = 0.5 m along
  // (1/2, sqrt(3)/2 * 1/2, sqrt(3)/2 * sqrt(3)/2).
  EXPECT_LT((reproject(example_pair(), 240.0, 240.0, 60.0) -
             Eigen::Vector3d(0.25, 0.125 * std::sqrt(3.0), 0.375))
                .norm(),
            1e-15);
}

TEST(SphericalPairTest, BothFormsOfTheRangeAgree) {
  // Thesis eq. 4.6 as corrected: k = B (cos alpha / tan delta - sin alpha).
  for (double u_px = 10.0; u_px < 340.0; u_px += 10.0) {
    for (double d_px = 1.0; (u_px + d_px - 180.0) * 0.5 < 89.5; d_px += 3.0) {
      const double alpha = (u_px - 180.0) * 0.5 * kDegree;
      const double delta = d_px * 0.5 * kDegree;
      const double k_m = 0.5 * (std::cos(alpha) / std::tan(delta) - std::sin(alpha));
      EXPECT_NEAR(reproject(example_pair(), u_px, 77.0, d_px).norm(), k_m, 1e-12 * (1.0 + k_m));
    }
  }
}

TEST(SphericalPairTest, ProjectsByTheAngles) {
  // (1, 0, 1): alpha 45 degrees; from (-0.5, 0, 0) it is (1.5, 0, 1).
  const double left_deg = std::atan(1.5) / kDegree;
  EXPECT_LT((project(example_pair(), {1.0, 0.0, 1.0}) -
             Eigen::Vector3d(270.0, 120.0, (left_deg - 45.0) / 0.5))
                .norm(),
            1e-11);
  // (-0.5, 3, sqrt(27)): straight ahead of the left camera, beta 30 degrees, off the axis by 6.
  EXPECT_LT((project(example_pair(), {-0.5, 3.0, std::sqrt(27.0)}) -
             Eigen::Vector3d(180.0 - std::atan(0.5 / 6.0) / kDegree / 0.5,
                             240.0,
                             std::atan(0.5 / 6.0) / kDegree / 0.5))
                .norm(),
            1e-11);
}

TEST(SphericalPairTest, BetaReachesAllRound) {
  // Straight up and straight behind: beta -90 and 180 degrees.
  EXPECT_NEAR(project(example_pair(), {0.0, -2.0, 0.0}).y(), 120.0 - 360.0, 1e-11);
  EXPECT_NEAR(project(example_pair(), {0.0, 1e-9, -2.0}).y(), 120.0 + 720.0, 1e-6);
  const Eigen::Vector3d behind_m(0.3, 1.0, -2.0);
  const Eigen::Vector3d pixel = project(example_pair(), behind_m);
  EXPECT_LT((reproject(example_pair(), pixel.x(), pixel.y(), pixel.z()) - behind_m).norm(), 1e-12);
}

TEST(SphericalPairTest, ARayIsAUnitVectorByTheAngles) {
  EXPECT_LT((ray_of(example_pair(), 180.0, 120.0) - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  const double half = 0.5;
  const double root = 0.5 * std::sqrt(3.0);
  EXPECT_LT((ray_of(example_pair(), 240.0, 240.0) - Eigen::Vector3d(half, root * half, root * root))
                .norm(),
            1e-15);
}

TEST(SphericalPairTest, WhatIsNoMatchGivesNoPoint) {
  const SphericalPair pair = example_pair();
  for (const double d_px : {0.0, -0.0, -1.0, -1e-9, -1e9, kNan}) {
    EXPECT_TRUE(reproject(pair, 150.0, 100.0, d_px).array().isNaN().all()) << d_px;
  }
  // alpha + delta = 90 and 91 degrees; alpha = 90, -90 and -91 degrees.
  for (const auto& [u_px, d_px] : {std::pair{300.0, 60.5},
                                   std::pair{300.0, 62.0},
                                   std::pair{180.0, 400.0},
                                   std::pair{360.5, 1.0},
                                   std::pair{-0.5, 10.0},
                                   std::pair{-2.0, 10.0},
                                   std::pair{kNan, 10.0},
                                   std::pair{180.0, std::numeric_limits<double>::infinity()}}) {
    EXPECT_TRUE(reproject(pair, u_px, 100.0, d_px).array().isNaN().all()) << u_px << ' ' << d_px;
  }
  EXPECT_TRUE(reproject(pair, 300.0, 100.0, 59.5).allFinite());
  EXPECT_TRUE(reproject(pair, 0.5, 100.0, 10.0).allFinite());
}

TEST(SphericalPairTest, UncertaintyByTheEquation) {
  // delta 45 degrees, alpha 0: B (pi/360) (1 + 1) per px, along (0, 0, 1).
  EXPECT_LT((uncertainty_m(example_pair(), {180.0, 120.0, 90.0}, 0.5) -
             Eigen::Vector3d(0.0, 0.0, 0.5 * kPi / 360.0 * 2.0 * 0.5))
                .norm(),
            1e-15);
  // alpha -30, delta 30 degrees: 0.5 cos(30) (pi/360) (1 + 3) per px, along (|-1/2|, 0, cos 30).
  const double root = 0.5 * std::sqrt(3.0);
  EXPECT_LT((uncertainty_m(example_pair(), {120.0, 120.0, 60.0}, 0.25) -
             0.5 * root * kPi / 360.0 * 4.0 * 0.25 * Eigen::Vector3d(0.5, 0.0, root))
                .norm(),
            1e-15);
}

TEST(SphericalPairTest, RangeUncertaintyStraightAhead) {
  // z = 5 m is 10 baselines: 0.5 * pi/360 * 101 per px.
  EXPECT_NEAR(delta_z_m(example_pair(), 5.0, 0.25), 0.5 * kPi / 360.0 * 101.0 * 0.25, 1e-14);
  EXPECT_NEAR(
      range_at_uncertainty_m(example_pair(), 0.5 * kPi / 360.0 * 101.0 * 0.25, 0.25), 5.0, 1e-12);
  // At no range is it below 0.5 * pi/360 per px.
  EXPECT_EQ(range_at_uncertainty_m(example_pair(), 0.4 * kPi / 360.0, 1.0), 0.0);
  EXPECT_NEAR(delta_z_m(example_pair(), 0.0, 1.0), 0.5 * kPi / 360.0, 1e-15);
}

TEST(SphericalPairTest, RangeAtADisparity) {
  EXPECT_NEAR(range_at_disparity_m(example_pair(), 90.0), 0.5, 1e-14);                    // 45 deg
  EXPECT_NEAR(range_at_disparity_m(example_pair(), 60.0), 0.5 * std::sqrt(3.0), 1e-14);   // 30 deg
  EXPECT_NEAR(range_at_disparity_m(example_pair(), 120.0), 0.5 / std::sqrt(3.0), 1e-14);  // 60 deg
  EXPECT_EQ(range_at_disparity_m(example_pair(), 181.0), 0.0);
  EXPECT_EQ(range_at_disparity_m(example_pair(), 300.0), 0.0);
  EXPECT_EQ(range_at_disparity_m(example_pair(), 400.0), 0.0);
  EXPECT_EQ(range_at_disparity_m(example_pair(), 0.0), std::numeric_limits<double>::infinity());
}

TEST(SphericalPairTest, TheNearestIsAtTheSide) {
  // 241 columns are 60 degrees to both sides of column 120. A search of 60 px, 30 degrees, finds
  // the nearest where the left ray is at +60: 0.5 cos(60)/sin(30).
  SphericalPair pair = example_pair();
  pair.principal_u_px = 120.0;
  EXPECT_NEAR(min_range_m(pair, 241, 60.0), 0.5, 1e-12);
  // 201 columns, 60 degrees to the left and 40 to the right: on the left, at alpha -60, the left
  // ray is at -30: 0.5 cos(-30)/sin(30) = 0.866; on the right 0.5 cos(40)/sin(30) = 0.766.
  EXPECT_NEAR(min_range_m(pair, 201, 60.0), std::cos(40.0 * kDegree), 1e-12);
  // 121 columns, the right side straight ahead: left 0.5 cos(-30)/sin(30), right 0.5/sin(30).
  EXPECT_NEAR(min_range_m(pair, 121, 60.0), 0.5 * std::sqrt(3.0), 1e-12);
  // A search of 110 degrees passes 90, where the left ray at +60 meets the right one nearest:
  // 0.5 cos(60)/sin(90).
  EXPECT_NEAR(min_range_m(pair, 241, 220.0), 0.25, 1e-12);
}

TEST(SphericalPairTest, DownscaledMovesThePrincipalPoint) {
  const SphericalPair half = downscaled(example_pair(), 2);
  EXPECT_DOUBLE_EQ(half.delta_theta_u_rad, kDegree);
  EXPECT_DOUBLE_EQ(half.delta_theta_v_rad, 0.5 * kDegree);
  EXPECT_DOUBLE_EQ(half.principal_u_px, 89.75);  // 180.5 / 2 - 0.5
  EXPECT_DOUBLE_EQ(half.principal_v_px, 59.75);  // 120.5 / 2 - 0.5
  EXPECT_DOUBLE_EQ(half.baseline_m, 0.5);
  const SphericalPair same = downscaled(example_pair(), 1);
  EXPECT_DOUBLE_EQ(same.delta_theta_u_rad, 0.5 * kDegree);
  EXPECT_DOUBLE_EQ(same.principal_u_px, 180.0);
}

}  // namespace
}  // namespace skyhalo
