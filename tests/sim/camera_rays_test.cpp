#include "skyhalo/sim/camera_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "support/example_lenses.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Angle between two rays, exact for small ones.
double angle_rad(const Vector3f& a, const Vector3d& b) {
  const Vector3d wide = a.cast<double>();
  return std::atan2(wide.cross(b).norm(), wide.dot(b));
}

/// Compares the rays through a pixel's middle with the lens's own; counts those outside the lens.
void expect_lens(const std::string& name, const RawCamera& camera, int& outside) {
  const CameraRays rays(camera);
  ASSERT_EQ(rays.size_px(), camera.size_px);
  for (int row = 0; row < camera.size_px.height; row += 7) {
    for (int col = 0; col < camera.size_px.width; col += 7) {
      bool whole = true;
      for (const Vector2d& corner :
           {Vector2d(-0.5, -0.5), Vector2d(0.5, -0.5), Vector2d(-0.5, 0.5), Vector2d(0.5, 0.5)}) {
        whole = whole && unproject(camera.lens, Vector2d(col, row) + corner).has_value();
      }
      const Vector3f middle = rays.at(row, col, 0.5F, 0.5F);
      if (!whole) {
        ++outside;
        EXPECT_TRUE(middle.isZero(0.0F)) << name << " " << col << ", " << row;
        continue;
      }
      const std::optional<Vector3d> exact = unproject(camera.lens, Vector2d(col, row));
      ASSERT_TRUE(exact);
      EXPECT_NEAR(middle.norm(), 1.0, 1e-5);
      const double from_axis_rad = std::acos(exact->z());
      if (from_axis_rad < max_angle_rad(camera.lens) - 0.6) {  // where no line bends much
        EXPECT_LT(angle_rad(middle, *exact), 1e-4) << name << " " << col << ", " << row;
      }
      const std::optional<Vector3d> corner = unproject(camera.lens, Vector2d(col + 0.5, row - 0.5));
      EXPECT_LT(angle_rad(rays.at(row, col, 1.0F, 0.0F), *corner), 1e-6);
    }
  }
}

TEST(CameraRaysReference, ThroughPixelsMiddlesTheyAreTheLenss) {
  int outside = 0;
  const Intrinsics wide{250.0, 252.0, 319.5, 241.0};
  const cv::Size size_px(640, 480);
  expect_lens(
      "pinhole", {size_px, RadialTangentialLens({400.0, 404.0, 319.5, 241.0}, {})}, outside);
  expect_lens("EuRoC",
              {{752, 480},
               RadialTangentialLens({458.654, 457.296, 367.215, 248.375},
                                    {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05})},
              outside);
  EXPECT_EQ(outside, 0);
  expect_lens("fisheye", {size_px, KannalaBrandtLens(wide, {0.01, -0.004, 0.001, 0.0})}, outside);
  expect_lens("double sphere", {size_px, DoubleSphereLens(wide, {-0.2, 0.6})}, outside);
  expect_lens("eucm", {size_px, ExtendedUnifiedLens(wide, {0.6, 1.1})}, outside);
  expect_lens("narrow circle",
              {size_px, KannalaBrandtLens({150.0, 150.0, 319.5, 239.5}, {-0.05, 0.0, 0.0, 0.0})},
              outside);
  EXPECT_GT(outside, 500);
}

TEST(CameraRaysTest, BetweenCornersTheyGoStraight) {
  const Intrinsics intrinsics{100.0, 100.0, 31.5, 23.5};
  const CameraRays rays({{64, 48}, RadialTangentialLens(intrinsics, {})});
  for (const auto& [x, y] : {std::pair(0.1F, 0.9F), std::pair(0.6F, 0.25F)}) {
    const Vector3d exact = Vector3d((60.0 - 0.5 + x - 31.5), (3.0 - 0.5 + y - 23.5), 100.0);
    EXPECT_LT(angle_rad(rays.at(3, 60, x, y), exact.normalized()), 1e-4);
  }
}

TEST(CameraRaysTest, APixelsWidthIsThatOfTheMiddle) {
  const Intrinsics intrinsics{100.0, 100.0, 31.5, 23.5};
  EXPECT_NEAR(CameraRays({{64, 48}, RadialTangentialLens(intrinsics, {})}).pixel_rad(), 0.01, 2e-4);
  const CameraRays fisheye({{64, 48}, KannalaBrandtLens(intrinsics, {})});
  EXPECT_NEAR(fisheye.pixel_rad(), 0.01, 2e-4);
}

void expect_pair(const PairModel& pair, const cv::Size& size_px, double left_shift_px) {
  const CameraRays right(pair, size_px, false);
  const CameraRays left(pair, size_px, true);
  ASSERT_EQ(left.size_px(), size_px);
  for (int row = 0; row < size_px.height; row += 5) {
    for (int col = 0; col < size_px.width; col += 5) {
      EXPECT_LT(angle_rad(right.at(row, col, 0.5F, 0.5F), ray_of(pair, col, row)), 1e-4);
      EXPECT_LT(angle_rad(left.at(row, col, 0.5F, 0.5F), ray_of(pair, col + left_shift_px, row)),
                1e-4);
    }
  }
}

TEST(CameraRaysReference, ARectifiedPairsRaysAreThoseOfItsModel) {
  expect_pair(PinholePair{300.0, 160.2, 120.7, 0.2, 0.0}, {320, 240}, 0.0);
  expect_pair(SphericalPair{0.004, 0.005, 160.2, 120.7, 0.2}, {320, 240}, 0.0);
  // With an offset of 4.5, what is infinitely far has a disparity of -4.5: left column u looks
  // where right column u + 4.5 does.
  expect_pair(PinholePair{300.0, 160.2, 120.7, 0.2, 4.5}, {320, 240}, 4.5);
}

TEST(CameraRaysProperty, BothCamerasOfAPairSeeAPointWhereTheModelHasIt) {
  const PairModel pair = PinholePair{300.0, 160.2, 120.7, 0.25, 4.5};
  const CameraRays left(pair, {320, 240}, true);
  for (int i = 0; i < 50; ++i) {
    const int row = 4 * i;
    const int right_col = 40 + 3 * i;
    const Vector3d point_m = (2.0 + 0.3 * i) * ray_of(pair, right_col, row);
    const double left_u_px = right_col + project(pair, point_m).z();
    const auto col = static_cast<int>(std::lround(left_u_px));
    ASSERT_TRUE(col >= 0 && col < 320);
    const auto x = static_cast<float>(left_u_px - col + 0.5);
    const Vector3d from_left = point_m - Vector3d(-0.25, 0.0, 0.0);
    EXPECT_LT(angle_rad(left.at(row, col, x, 0.5F), from_left.normalized()), 1e-4);
  }
}

}  // namespace
}  // namespace skyhalo
