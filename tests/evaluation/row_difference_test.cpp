#include "skyhalo/evaluation/row_difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

/// The part at (left, top) of a wall of random discs and boxes, seen by pixels that each take the
/// mean of 8 x 8 points of it: a move by a whole number of eighths of a pixel is exact.
class Wall {
 public:
  explicit Wall(unsigned seed) : points_(kFine * 400, kFine * 560, 128) {
    cv::RNG random(seed);
    for (int i = 0; i < 700; ++i) {
      const cv::Point at(random.uniform(0, points_.cols), random.uniform(0, points_.rows));
      const int size = random.uniform(3 * kFine, 16 * kFine);
      const int grey = random.uniform(20, 236);
      if (i % 2 == 0) {
        cv::circle(points_, at, size, grey, cv::FILLED);
      } else {
        cv::rectangle(points_, {at, cv::Size(2 * size, size)}, grey, cv::FILLED);
      }
    }
  }

  [[nodiscard]] cv::Mat1b seen_from(double left_px, double top_px) const {
    const cv::Rect part(
        cvRound(left_px * kFine), cvRound(top_px * kFine), kFine * 480, kFine * 320);
    cv::Mat1b image;
    cv::resize(points_(part), image, {480, 320}, 0.0, 0.0, cv::INTER_AREA);
    return image;
  }

 private:
  static constexpr int kFine = 8;
  cv::Mat1b points_;
};

/// With noise of 2 grey values.
cv::Mat1b noisy(const cv::Mat1b& image, unsigned seed) {
  cv::Mat1s noise(image.size());
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
  cv::Mat1b sum;
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

/// Median of how far the matches' row difference is from the true one.
double median_error_px(const RowDifference& rows, double dv_px) {
  std::vector<double> errors;
  for (const PairMatch& match : rows.inliers) {
    errors.push_back(std::abs(match.dv_px - dv_px));
  }
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? std::nan("") : errors[errors.size() / 2];
}

TEST(RowDifferenceTest, EqualImagesAreLevel) {
  const cv::Mat1b image = Wall(1).seen_from(20.0, 20.0);
  const RowDifference rows = row_difference(image, image);
  EXPECT_GT(rows.matches, 200);
  EXPECT_EQ(rows.matches, static_cast<int>(rows.inliers.size()));
  EXPECT_EQ(rows.median_abs_dv_px, 0.0);
  EXPECT_EQ(rows.p90_abs_dv_px, 0.0);
  EXPECT_EQ(rows.median_disparity_px, 0.0);
  EXPECT_EQ(rows.negative_disparity_share, 0.0);
}

TEST(RowDifferenceTest, TheNoiseFloorIsBelowATenthOfAPixel) {
  const Wall wall(2);
  for (const double dv_px : {0.0, 0.125, 0.375, 0.5, -0.25, 1.625}) {
    // What the left image shows at row v + dv, the right one shows at row v.
    const cv::Mat1b left = noisy(wall.seen_from(20.0, 20.0), 5);
    const cv::Mat1b right = noisy(wall.seen_from(20.0 + 7.375, 20.0 + dv_px), 6);
    const RowDifference rows = row_difference(left, right);
    EXPECT_GT(rows.matches, 200);
    EXPECT_NEAR(rows.median_dv_px, dv_px, 0.06);
    EXPECT_NEAR(rows.median_disparity_px, 7.375, 0.06);
    EXPECT_LT(median_error_px(rows, dv_px), 0.1) << dv_px;
  }
}

TEST(RowDifferenceTest, MatchesCarryPlaceDisparityAndDifference) {
  const Wall wall(3);
  const RowDifference rows = row_difference(wall.seen_from(20.0, 20.0), wall.seen_from(32.0, 17.0));
  ASSERT_GT(rows.inliers.size(), 100U);
  int at_12_px = 0;
  for (const PairMatch& match : rows.inliers) {
    at_12_px += std::abs(match.disparity_px - 12.0) < 1.0 ? 1 : 0;
    EXPECT_NEAR(match.dv_px, -3.0, 2.5);
    EXPECT_TRUE(cv::Rect2d(0.0, 0.0, 480.0, 320.0).contains(match.right_px));
  }
  EXPECT_GT(at_12_px, 0.95 * rows.matches);
  EXPECT_NEAR(rows.median_abs_dv_px, 3.0, 0.05);
  EXPECT_NEAR(rows.median_dv_px, -3.0, 0.05);
}

TEST(RowDifferenceTest, SwappedCamerasShow) {
  const Wall wall(4);
  const cv::Mat1b left = wall.seen_from(20.0, 20.0);
  const cv::Mat1b right = wall.seen_from(30.0, 20.0);
  EXPECT_LT(row_difference(left, right).negative_disparity_share, 0.02);
  const RowDifference swapped = row_difference(right, left);
  EXPECT_GT(swapped.matches, 200);
  EXPECT_GT(swapped.negative_disparity_share, 0.98);
  EXPECT_NEAR(swapped.median_disparity_px, -10.0, 0.05);
}

TEST(RowDifferenceTest, ATiltIsReportedAndNotTakenAway) {
  // The left image turned by 1.5 degrees about its middle: dv grows by sin(1.5 deg) = 0.0262 per
  // column, up to 6.3 px, more than would pass about one common shift.
  const cv::Mat1b image = Wall(5).seen_from(20.0, 20.0);
  const cv::Matx23d turn(cv::Mat1d(cv::getRotationMatrix2D({239.5F, 159.5F}, -1.5, 1.0)));
  cv::Mat1b turned;
  cv::warpAffine(image, turned, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  const RowDifference rows = row_difference(turned, image);
  ASSERT_GT(rows.matches, 150);
  std::vector<double> expected;
  for (const PairMatch& match : rows.inliers) {
    const double dv_px = 0.0262 * (match.right_px.x - 239.5);
    expected.push_back(std::abs(dv_px));
    EXPECT_NEAR(match.dv_px, dv_px, 2.5);
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_NEAR(rows.median_abs_dv_px, expected[expected.size() / 2], 0.2);
  EXPECT_NEAR(rows.p90_abs_dv_px, expected[expected.size() * 9 / 10], 0.3);
  EXPECT_GT(rows.median_abs_dv_px, 1.5);
}

TEST(RowDifferenceTest, RowsFarApartAreNoMatch) {
  const Wall wall(6);
  EXPECT_GT(row_difference(wall.seen_from(20.0, 20.0), wall.seen_from(20.0, 35.0)).matches, 150);
  EXPECT_LT(row_difference(wall.seen_from(20.0, 20.0), wall.seen_from(20.0, 40.0)).matches, 10);
}

TEST(RowDifferenceTest, DifferentScenesHardlyMatch) {
  EXPECT_LT(row_difference(Wall(7).seen_from(0.0, 0.0), Wall(8).seen_from(0.0, 0.0)).matches, 15);
}

TEST(RowDifferenceTest, WhatIsNotValidIsLeftOut) {
  const Wall wall(9);
  const cv::Mat1b left = wall.seen_from(20.0, 20.0);
  const cv::Mat1b right = wall.seen_from(28.0, 20.0);
  cv::Mat1b valid(left.size(), 255);
  valid.colRange(240, 480) = 0;
  const auto rightmost_px = [](const RowDifference& rows) {
    double u_px = 0.0;
    for (const PairMatch& match : rows.inliers) {
      u_px = std::max(u_px, match.right_px.x);
    }
    return u_px;
  };
  EXPECT_GT(rightmost_px(row_difference(left, right)), 400.0);
  const RowDifference by_right = row_difference(left, right, {}, valid);
  EXPECT_GT(by_right.matches, 80);
  EXPECT_LT(rightmost_px(by_right), 240.0 - 11.0);
  EXPECT_LT(rightmost_px(row_difference(left, right, valid, {})), 240.0 - 8.0 - 10.0);
}

TEST(RowDifferenceTest, WithoutFeaturesTheStatisticsAreNan) {
  for (const cv::Size& size : {cv::Size(320, 240),
                               cv::Size(500, 30),
                               cv::Size(25, 25),
                               cv::Size(24, 400),
                               cv::Size(1, 1)}) {
    const cv::Mat1b flat(size, 90);
    const RowDifference rows = row_difference(flat, flat);
    EXPECT_EQ(rows.matches, 0);
    EXPECT_TRUE(rows.inliers.empty());
    for (const double value : {rows.median_dv_px,
                               rows.median_abs_dv_px,
                               rows.p90_abs_dv_px,
                               rows.median_disparity_px,
                               rows.negative_disparity_share}) {
      EXPECT_TRUE(std::isnan(value));
    }
  }
}

TEST(RowDifferenceTest, IsTheSameWithOneThread) {
  const Wall wall(10);
  const cv::Mat1b left = wall.seen_from(20.0, 20.0);
  const cv::Mat1b right = wall.seen_from(26.5, 20.25);
  const RowDifference many = row_difference(left, right);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const RowDifference one = row_difference(left, right);
  cv::setNumThreads(threads);
  ASSERT_EQ(one.matches, many.matches);
  EXPECT_EQ(one.median_dv_px, many.median_dv_px);
  EXPECT_EQ(one.p90_abs_dv_px, many.p90_abs_dv_px);
  for (std::size_t i = 0; i < one.inliers.size(); ++i) {
    EXPECT_EQ(one.inliers[i].right_px, many.inliers[i].right_px);
    EXPECT_EQ(one.inliers[i].dv_px, many.inliers[i].dv_px);
  }
}

/// A raw camera of the flight, as its `sensor.yaml` gives it.
struct PublishedCamera {
  cv::Matx33d K;
  cv::Vec4d distortion;
  cv::Matx44d T_imu_camera;
};

PublishedCamera left_camera() {
  return {{458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1},
          {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05},
          {0.0148655429818,
           -0.999880929698,
           0.00414029679422,
           -0.0216401454975,
           0.999557249008,
           0.0149672133247,
           0.025715529948,
           -0.064676986768,
           -0.0257744366974,
           0.00375618835797,
           0.999660727178,
           0.00981073058949,
           0.0,
           0.0,
           0.0,
           1.0}};
}

PublishedCamera right_camera() {
  return {{457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1},
          {-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05},
          {0.0125552670891,
           -0.999755099723,
           0.0182237714554,
           -0.0198435579556,
           0.999598781151,
           0.0130119051815,
           0.0251588363115,
           0.0453689425024,
           -0.0253898008918,
           0.0179005838253,
           0.999517347078,
           0.00786212447038,
           0.0,
           0.0,
           0.0,
           1.0}};
}

/// Rectifies with OpenCV alone.
class OpenCvRectifier {
 public:
  OpenCvRectifier() {
    const PublishedCamera left = left_camera();
    const PublishedCamera right = right_camera();
    const cv::Matx44d T = right.T_imu_camera.inv() * left.T_imu_camera;
    cv::Matx33d turn_left;
    cv::Matx33d turn_right;
    cv::Matx34d projection_left;
    cv::Matx34d projection_right;
    cv::Mat Q;
    const cv::Size size(752, 480);
    cv::stereoRectify(left.K,
                      left.distortion,
                      right.K,
                      right.distortion,
                      size,
                      T.get_minor<3, 3>(0, 0),
                      T.get_minor<3, 1>(0, 3),
                      turn_left,
                      turn_right,
                      projection_left,
                      projection_right,
                      Q,
                      cv::CALIB_ZERO_DISPARITY,
                      0.0,
                      size);
    cv::initUndistortRectifyMap(
        left.K, left.distortion, turn_left, projection_left, size, CV_32FC1, left_u_, left_v_);
    cv::initUndistortRectifyMap(right.K,
                                right.distortion,
                                turn_right,
                                projection_right,
                                size,
                                CV_32FC1,
                                right_u_,
                                right_v_);
  }

  [[nodiscard]] RowDifference measure(const std::string& name) const {
    const auto cameras = testing::recorded_data() / "euroc_V1_01_flight/mav0";
    cv::Mat1b left;
    cv::Mat1b right;
    cv::remap(read_image(cameras / "cam0/data" / name), left, left_u_, left_v_, cv::INTER_LINEAR);
    cv::remap(
        read_image(cameras / "cam1/data" / name), right, right_u_, right_v_, cv::INTER_LINEAR);
    return row_difference(left, right);
  }

 private:
  cv::Mat1f left_u_;
  cv::Mat1f left_v_;
  cv::Mat1f right_u_;
  cv::Mat1f right_v_;
};

TEST(RowDifferenceSystem, ARecordedFlightIsLevelWhenRectifiedByOpenCv) {
  SKYHALO_SKIP_WITHOUT(testing::recorded_data() / "euroc_V1_01_flight");
  const OpenCvRectifier rectifier;
  for (const char* const name : {"1403715273262142976.jpg", "1403715280562142976.jpg"}) {
    const RowDifference rows = rectifier.measure(name);
    EXPECT_GE(rows.matches, 200);
    EXPECT_LT(rows.median_abs_dv_px, 0.25);
    EXPECT_LT(rows.negative_disparity_share, 0.02);
    EXPECT_GT(rows.median_disparity_px, 5.0);
  }
}

}  // namespace
}  // namespace skyhalo
