#include "skyhalo/stereo/opencv_sgbm.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

TEST(OpencvSgbmTest, TheLastColumnsOfTheSearchRangeStayEmpty) {
  const auto [left, right] = testing::textured_pair({120, 40}, 6, 5);
  MatcherConfig config;
  config.max_disparity_px = 32;
  OpencvSgbm engine(config);
  cv::Mat1f disparity;
  engine.match(left, right, disparity);
  ASSERT_EQ(disparity.size(), cv::Size(120, 40));
  const cv::Mat is_found = disparity == disparity;
  EXPECT_EQ(cv::countNonZero(is_found.colRange(120 - 32, 120)), 0);
  EXPECT_GT(cv::countNonZero(is_found.colRange(0, 120 - 32)), 88 * 40 / 2);
}

TEST(OpencvSgbmTest, SteersByThePixelOfTheRightImage) {
  // A square before the ground: left at u = 60, right at u = 50, disparity 10; the ground has 2.
  auto [left, right] = testing::textured_pair({120, 60}, 2, 6);
  const cv::Mat1b square = testing::texture({24, 24}, 7);
  square.copyTo(left(cv::Rect(60, 20, 24, 24)));
  square.copyTo(right(cv::Rect(50, 20, 24, 24)));
  MatcherConfig config;
  config.max_disparity_px = 16;
  config.opencv.speckle_size_px = 0;
  OpencvSgbm engine(config);
  cv::Mat1f disparity;
  engine.match(left, right, disparity);
  EXPECT_NEAR(disparity(32, 54), 10.0F, 0.25F);
  EXPECT_NEAR(disparity(32, 62), 10.0F, 0.25F);
  EXPECT_NEAR(disparity(32, 90), 2.0F, 0.25F);
  EXPECT_NEAR(disparity(32, 30), 2.0F, 0.25F);
  // Inside the square in the left image, right of it in the right one.
  EXPECT_FALSE(std::abs(disparity(32, 79) - 10.0F) < 1.0F);
}

TEST(OpencvSgbmTest, AlignedLeftTheFirstColumnsStayEmpty) {
  const auto [left, right] = testing::textured_pair({120, 40}, 6, 5);
  MatcherConfig config;
  config.max_disparity_px = 32;
  config.alignment = Alignment::kLeft;
  OpencvSgbm engine(config);
  cv::Mat1f disparity;
  engine.match(left, right, disparity);
  const cv::Mat is_found = disparity == disparity;
  EXPECT_EQ(cv::countNonZero(is_found.colRange(0, 32)), 0);
  EXPECT_GT(cv::countNonZero(is_found.colRange(32, 120)), 88 * 40 / 2);
  EXPECT_NEAR(disparity(20, 80), 6.0F, 0.25F);
}

TEST(OpencvSgbmTest, FindsAPlaneWithAnyNumberOfPathsAndSizeOfBlocks) {
  const auto [left, right] = testing::textured_pair({220, 50}, 17, 3);
  MatcherConfig config;
  config.max_disparity_px = 48;
  for (const int paths : {3, 5, 8}) {
    for (const int block_px : {1, 3, 5, 11}) {
      config.opencv.paths = paths;
      config.opencv.block_px = block_px;
      OpencvSgbm engine(config);
      cv::Mat1f disparity;
      engine.match(left, right, disparity);
      int right_ones = 0;
      for (const float d_px : cv::Mat1f(disparity.colRange(0, 220 - 48))) {
        right_ones += std::abs(d_px - 17.0F) <= 0.25F ? 1 : 0;
      }
      EXPECT_GT(right_ones, (220 - 48) * 50 * 9 / 10) << paths << " paths, " << block_px << " px";
    }
  }
}

TEST(OpencvSgbmTest, WritesOverWhatTheDisparityHeld) {
  const auto [left, right] = testing::textured_pair({100, 30}, 4, 8);
  MatcherConfig config;
  config.max_disparity_px = 16;
  OpencvSgbm engine(config);
  cv::Mat1f disparity(30, 100, 1234.0F);
  engine.match(left, right, disparity);
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      EXPECT_TRUE(std::isnan(disparity(v, u)) || disparity(v, u) < 16.0F);
    }
  }
}

}  // namespace
}  // namespace skyhalo
