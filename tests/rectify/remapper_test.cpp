#include "skyhalo/rectify/remapper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "rectify/compared_images.hpp"
#include "rectify/remap_cases.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::centroid;
using testing::goal_of;
using testing::ideal_pinhole;
using testing::RemapCase;
using testing::remapped;
using testing::window_round;

const cv::Size kSize(96, 64);

TEST(RemapperTest, AnIdealPinholeGivesItsImageBack) {
  const cv::Mat1b raw = testing::texture(kSize, 1);
  Remapper remapper(goal_of(ideal_pinhole(kSize, {0.0, 0.0}), 1));
  const cv::Mat1b out = remapped(remapper, raw);
  ASSERT_EQ(out.size(), kSize);
  EXPECT_EQ(cv::norm(out, raw, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::countNonZero(remapper.valid()), kSize.area());
}

/// How many pixels are not the mean of their block, rounded.
int count_not_means(const cv::Mat1b& out, const cv::Mat1b& raw, int factor) {
  int wrong = 0;
  for (int i = 0; i < out.size().area(); ++i) {
    const int u = i % out.cols;
    const int v = i / out.cols;
    const double mean = cv::mean(raw(cv::Rect(u * factor, v * factor, factor, factor)))[0];
    wrong += std::abs(out(v, u) - mean) > 0.5 + 1e-6 ? 1 : 0;
  }
  return wrong;
}

TEST(RemapperTest, AnIdealPinholeIsShrunkByTheMeansOfItsBlocks) {
  const cv::Mat1b raw = testing::texture(kSize, 2);
  for (const int factor : {2, 4}) {
    Remapper remapper(goal_of(ideal_pinhole(kSize, {0.0, 0.0}), factor));
    const cv::Mat1b out = remapped(remapper, raw);
    ASSERT_EQ(out.size(), kSize / factor);
    EXPECT_EQ(cv::countNonZero(remapper.valid()), out.size().area());
    EXPECT_EQ(count_not_means(out, raw, factor), 0);
  }
}

TEST(RemapperTest, AWholeShiftMovesTheImage) {
  const cv::Mat1b raw = testing::texture(kSize, 3);
  Remapper remapper(goal_of(ideal_pinhole(kSize, {7.0, -5.0}), 1));
  const cv::Mat1b out = remapped(remapper, raw);
  // Pixel (u, v) sees (u + 7, v - 5).
  const cv::Rect seen(0, 5, 89, 59);
  EXPECT_EQ(cv::norm(out(seen), raw(seen + cv::Point(7, -5)), cv::NORM_INF), 0.0);
}

TEST(RemapperTest, AHalfShiftIsTheMeanOfTwo) {
  const cv::Mat1b raw = testing::texture(kSize, 4);
  Remapper remapper(goal_of(ideal_pinhole(kSize, {0.5, 0.0}), 1));
  const cv::Mat1b out = remapped(remapper, raw);
  for (int u = 0; u < 95; ++u) {
    EXPECT_NEAR(out(30, u), 0.5 * (raw(30, u) + raw(30, u + 1)), 0.5 + 1e-6) << u;
  }
}

TEST(RemapperTest, BlocksAreAsLargeAsThePixels) {
  for (const int factor : {1, 2, 3, 4, 8}) {
    EXPECT_EQ(Remapper(goal_of(ideal_pinhole(kSize, {0.0, 0.0}), factor)).block_px(), factor);
  }
}

TEST(RemapperTest, BlocksFollowTheRawResolution) {
  // Virtual images of a third of the raw focal length are as coarse at factor 1 as others at 3.
  RemapCase coarse = ideal_pinhole(kSize, {0.0, 0.0});
  std::get<PinholePair>(coarse.model).focal_px /= 3.0;
  EXPECT_EQ(Remapper(goal_of(coarse, 1)).block_px(), 3);
  EXPECT_EQ(Remapper(goal_of(coarse, 2)).block_px(), 6);
  // And finer ones need no mean.
  RemapCase fine = ideal_pinhole(kSize, {0.0, 0.0});
  std::get<PinholePair>(fine.model).focal_px *= 4.0;
  EXPECT_EQ(Remapper(goal_of(fine, 1)).block_px(), 1);
}

/// How many pixels of the mask differ from those whose surroundings, four means of blocks, lie in
/// the raw image when pixel (u, v) sees the raw (u, v) + shift.
int count_wrong(const cv::Mat1b& valid, const Eigen::Vector2d& shift_px, int block_px) {
  const auto is_inside = [&](int at, double shift, int side) {
    const double raw = (at + 0.5) * block_px - 0.5 + shift;
    const double first = std::floor((raw + 0.5) / block_px - 0.5);
    const int blocks = side / block_px;
    return first >= 0.0 && first + 1.0 <= blocks - 1.0;
  };
  int wrong = 0;
  for (int v = 0; v < valid.rows; ++v) {
    for (int u = 0; u < valid.cols; ++u) {
      const bool expected =
          is_inside(u, shift_px.x(), kSize.width) && is_inside(v, shift_px.y(), kSize.height);
      wrong += valid(v, u) == (expected ? 255 : 0) ? 0 : 1;
    }
  }
  return wrong;
}

TEST(RemapperTest, PixelsAreValidIffTheirSurroundingsLieInTheRawImage) {
  for (const int factor : {1, 2, 4}) {
    for (const Eigen::Vector2d& shift : {Eigen::Vector2d(10.3, -5.6),
                                         Eigen::Vector2d(-10.3, 5.6),
                                         Eigen::Vector2d(0.4, 0.4),
                                         Eigen::Vector2d(-0.4, -0.4)}) {
      const Remapper remapper(goal_of(ideal_pinhole(kSize, shift), factor));
      ASSERT_EQ(remapper.block_px(), factor);
      EXPECT_EQ(count_wrong(remapper.valid(), shift, factor), 0)
          << "factor " << factor << ", shift " << shift.transpose();
    }
  }
}

TEST(RemapperTest, InvalidPixelsAreZeroAndValidOnesWhole) {
  const cv::Mat1b raw(kSize, uchar{200});
  for (const int factor : {1, 2, 4}) {
    Remapper remapper(goal_of(ideal_pinhole(kSize, {10.3, -5.6}), factor));
    const cv::Mat1b out = remapped(remapper, raw);
    cv::Mat1b expected;
    cv::min(remapper.valid(), 200.0, expected);
    EXPECT_GT(cv::countNonZero(expected), 0);
    EXPECT_LT(cv::countNonZero(expected), out.size().area());
    EXPECT_EQ(cv::norm(out, expected, cv::NORM_INF), 0.0) << "factor " << factor;
  }
}

TEST(RemapperTest, NothingIsSeenBehindTheCamera) {
  RemapCase behind = ideal_pinhole(kSize, {0.0, 0.0});
  behind.R_raw_cam = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Remapper remapper(goal_of(behind, 2));
  EXPECT_EQ(cv::countNonZero(remapper.valid()), 0);
  EXPECT_EQ(cv::countNonZero(remapped(remapper, cv::Mat1b(kSize, uchar{200}))), 0);
}

TEST(RemapperTest, NothingIsSeenBeyondTheLens) {
  // r = theta - 0.3 theta^3 grows up to 60.4 degrees; beyond, the polynomial folds back into the
  // image.
  const RemapCase folding{
      .name = "fisheye that folds back",
      .camera = {{752, 480}, KannalaBrandtLens({366.0, 366.0, 375.5, 239.5}, {-0.3, 0, 0, 0})},
      .model = SphericalPair{.delta_theta_u_rad = 1.0 / 100.0,
                             .delta_theta_v_rad = 1.0 / 100.0,
                             .principal_u_px = 149.5,
                             .principal_v_px = 59.5,
                             .baseline_m = 0.3},
      .size_px = {300, 120}};
  const double max_rad = max_angle_rad(folding.camera.lens);
  ASSERT_NEAR(max_rad, std::sqrt(1.0 / 0.9), 0.01);
  Remapper remapper(goal_of(folding, 1));
  const cv::Mat1b out = remapped(remapper, cv::Mat1b(folding.camera.size_px, uchar{200}));
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 300; ++u) {
      const Eigen::Vector3d ray = ray_of(folding.model, u, v);
      const bool is_seen = std::acos(ray.z()) <= max_rad;
      ASSERT_EQ(remapper.valid()(v, u), is_seen ? 255 : 0) << u << ", " << v;
      ASSERT_EQ(out(v, u), is_seen ? 200 : 0) << u << ", " << v;
    }
  }
}

TEST(RemapperTest, ATurnTakesCamToTheRawCamera) {
  // A light at (10, -6) degrees from the raw axis; the virtual camera looks 10 degrees to the
  // right, so that its rays leave the raw camera to the right: the light is straight ahead.
  const cv::Size size(480, 320);
  RemapCase turned = ideal_pinhole(size, {0.0, 0.0});
  const double angle_rad = 10.0 / 180.0 * std::numbers::pi;
  turned.R_raw_cam = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector2d light_px(239.5 + 200.0 * std::tan(angle_rad), 140.0);
  const cv::Mat1b raw = testing::render(turned.camera, [&](const Eigen::Vector3d& ray) {
    const Eigen::Vector2d pixel(239.5 + 200.0 * ray.x() / ray.z(),
                                159.5 + 200.0 * ray.y() / ray.z());
    return 250.0 * std::exp(-0.5 * (pixel - light_px).squaredNorm() / 9.0);
  });
  Remapper remapper(goal_of(turned, 1));
  const cv::Mat1b out = remapped(remapper, raw);
  // Up by 19.5 px, where the raw ray is longer than the axis by 1 / cos(10 deg).
  const Eigen::Vector2d expected(239.5, 159.5 - 19.5 * std::cos(angle_rad));
  const Eigen::Vector2d found = centroid(out, window_round(expected, 12));
  EXPECT_NEAR(found.x(), expected.x(), 0.05);
  EXPECT_NEAR(found.y(), expected.y(), 0.05);
}

TEST(RemapperTest, ServesImageAfterImage) {
  Remapper remapper(goal_of(ideal_pinhole(kSize, {0.0, 0.0}), 2));
  cv::Mat1b out;
  for (int value = 0; value < 250; value += 50) {
    remapper.remap(cv::Mat1b(kSize, static_cast<uchar>(value)), out);
    EXPECT_EQ(cv::countNonZero(out == value), out.size().area());
  }
}

}  // namespace
}  // namespace skyhalo
