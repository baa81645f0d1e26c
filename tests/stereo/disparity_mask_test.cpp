#include "skyhalo/stereo/disparity_mask.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace skyhalo {
namespace {

constexpr float kDisparity = 7.0F;

/// True at (u, v) where the pixel was discarded; kept pixels must be untouched.
bool is_discarded(const cv::Mat1f& disparity, int u, int v) {
  const float value = disparity(v, u);
  EXPECT_TRUE(std::isnan(value) || value == kDisparity);
  return std::isnan(value);
}

void expect_discarded(const cv::Mat1f& disparity, const cv::Rect& expected) {
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      EXPECT_EQ(is_discarded(disparity, u, v), expected.contains({u, v})) << u << ", " << v;
    }
  }
}

cv::Mat1f cropped(int width, int rcrop_px) {
  cv::Mat1f disparity(3, width, kDisparity);
  discard_right_columns(disparity, rcrop_px);
  return disparity;
}

cv::Mat1f masked(const cv::Rect& mask, int downscale) {
  cv::Mat1f disparity(6, 8, kDisparity);
  const std::array masks{mask};
  discard_rectangles(disparity, masks, downscale);
  return disparity;
}

TEST(DisparityMaskTest, KeepsColumnJIffWidthMinusJExceedsRcrop) {
  // Thesis eq. 5.1, corrected: 10 - j > 3 holds for j = 0 ... 6.
  expect_discarded(cropped(10, 3), {7, 0, 3, 3});
}

TEST(DisparityMaskTest, AnRcropOfNothingKeepsAll) {
  expect_discarded(cropped(10, 0), {});
  expect_discarded(cropped(10, -4), {});
}

TEST(DisparityMaskTest, AnRcropOfTheWidthDiscardsAll) {
  expect_discarded(cropped(10, 9), {1, 0, 9, 3});
  expect_discarded(cropped(10, 10), {0, 0, 10, 3});
  expect_discarded(cropped(10, 1000), {0, 0, 10, 3});
}

TEST(DisparityMaskTest, AnEmptyImageStaysEmpty) {
  cv::Mat1f disparity;
  discard_right_columns(disparity, 3);
  EXPECT_TRUE(disparity.empty());
}

TEST(DisparityMaskTest, DiscardsARectangle) {
  expect_discarded(masked({2, 1, 3, 2}, 1), {2, 1, 3, 2});
}

TEST(DisparityMaskTest, DiscardsEveryPixelThatTouchesARectangle) {
  // Full-resolution columns 3...6 lie in the columns 1...3 of half the size, rows 1...2 in 0...1.
  expect_discarded(masked({3, 1, 4, 2}, 2), {1, 0, 3, 2});
  // Even coordinates fit exactly.
  expect_discarded(masked({2, 4, 4, 2}, 2), {1, 2, 2, 1});
  // One pixel, (5, 5), lies in (1, 1) of a quarter of the size.
  expect_discarded(masked({5, 5, 1, 1}, 4), {1, 1, 1, 1});
}

TEST(DisparityMaskTest, IgnoresWhatLiesOutside) {
  expect_discarded(masked({-3, -2, 5, 4}, 1), {0, 0, 2, 2});
  expect_discarded(masked({6, 4, 100, 100}, 1), {6, 4, 2, 2});
  expect_discarded(masked({-10, -10, 5, 5}, 1), {});
  expect_discarded(masked({8, 0, 5, 5}, 1), {});
  expect_discarded(masked({-5, -5, 1000, 1000}, 1), {0, 0, 8, 6});
}

TEST(DisparityMaskTest, IgnoresWhatLiesOutsideAtHalfTheSize) {
  // Columns -3...0: only column 0 is in the image. Columns -3...-2 do not reach it.
  expect_discarded(masked({-3, 0, 4, 2}, 2), {0, 0, 1, 1});
  expect_discarded(masked({-3, 0, 2, 2}, 2), {});
  // The image has 16 full-resolution columns; 15...18 touches the last.
  expect_discarded(masked({15, 11, 4, 4}, 2), {7, 5, 1, 1});
}

TEST(DisparityMaskTest, AnEmptyRectangleDiscardsNothing) {
  expect_discarded(masked({2, 2, 0, 0}, 2), {});
  expect_discarded(masked({3, 3, 0, 0}, 2), {});
  expect_discarded(masked({3, 3, 0, 2}, 2), {});
}

TEST(DisparityMaskTest, NoRectanglesDiscardNothing) {
  cv::Mat1f disparity(6, 8, kDisparity);
  discard_rectangles(disparity, {}, 2);
  expect_discarded(disparity, {});
}

TEST(DisparityMaskProperty, APixelGoesIffItsBlockMeetsARectangle) {
  std::mt19937 random(31);
  std::uniform_int_distribution<int> corner(-20, 60);
  std::uniform_int_distribution<int> side(1, 25);
  for (int round = 0; round < 200; ++round) {
    const int downscale = 1 + round % 4;
    const std::vector<cv::Rect> masks{{corner(random), corner(random), side(random), side(random)},
                                      {corner(random), corner(random), side(random), side(random)}};
    cv::Mat1f disparity(11, 13, kDisparity);
    discard_rectangles(disparity, masks, downscale);
    for (int i = 0; i < disparity.rows * disparity.cols; ++i) {
      const int u = i % disparity.cols;
      const int v = i / disparity.cols;
      const cv::Rect block(u * downscale, v * downscale, downscale, downscale);
      const bool expected = !(block & masks[0]).empty() || !(block & masks[1]).empty();
      EXPECT_EQ(is_discarded(disparity, u, v), expected);
    }
  }
}

}  // namespace
}  // namespace skyhalo
