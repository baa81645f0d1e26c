#include "skyhalo/stereo/disparity_mask.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
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

/// Masks of an 8 x 2 image that are 255 but for some columns.
cv::Mat1b seen_but(const std::vector<int>& columns) {
  cv::Mat1b mask(2, 8, uchar{255});
  for (const int column : columns) {
    mask.col(column) = 0;
  }
  return mask;
}

/// An image of 8 x 2 pixels with one disparity, of which unseen ones were discarded.
cv::Mat1f with_unseen(float disparity_px, const cv::Mat1b& right, const cv::Mat1b& left) {
  cv::Mat1f disparity(2, 8, disparity_px);
  discard_unseen(disparity, right, left);
  return disparity;
}

/// The columns that were kept, the same in both rows, with their disparity.
std::vector<int> kept_columns(const cv::Mat1f& disparity, float disparity_px) {
  std::vector<int> kept;
  for (int u = 0; u < disparity.cols; ++u) {
    EXPECT_EQ(std::isnan(disparity(0, u)), std::isnan(disparity(1, u))) << u;
    if (!std::isnan(disparity(0, u))) {
      EXPECT_EQ(disparity(0, u), disparity_px) << u;
      kept.push_back(u);
    }
  }
  return kept;
}

using Columns = std::vector<int>;

TEST(DisparityMaskTest, PixelsThatTheRightCameraDidNotSeeGo) {
  const cv::Mat1f disparity = with_unseen(2.0F, seen_but({0, 3}), {});
  EXPECT_EQ(kept_columns(disparity, 2.0F), (Columns{1, 2, 4, 5, 6, 7}));
}

TEST(DisparityMaskTest, PixelsWhoseMatchTheLeftCameraDidNotSeeGo) {
  // Column 4 of the left image is the match of column 2; those of 6 and 7 lie outside.
  EXPECT_EQ(kept_columns(with_unseen(2.0F, {}, seen_but({4})), 2.0F), (Columns{0, 1, 3, 4, 5}));
  EXPECT_EQ(kept_columns(with_unseen(0.0F, {}, seen_but({4})), 0.0F),
            (Columns{0, 1, 2, 3, 5, 6, 7}));
}

TEST(DisparityMaskTest, EitherCameraDiscards) {
  const cv::Mat1f disparity = with_unseen(2.0F, seen_but({0}), seen_but({4}));
  EXPECT_EQ(kept_columns(disparity, 2.0F), (Columns{1, 3, 4, 5}));
}

TEST(DisparityMaskTest, TheMatchIsTheNearestColumn) {
  // 2 + 1.49 is nearest to 3 and 2 + 1.51 to 4.
  EXPECT_EQ(kept_columns(with_unseen(1.49F, {}, seen_but({4})), 1.49F),
            (Columns{0, 1, 2, 4, 5, 6}));
  EXPECT_EQ(kept_columns(with_unseen(1.51F, {}, seen_but({4})), 1.51F), (Columns{0, 1, 3, 4, 5}));
  // 7 + 0.49 is still column 7; 7 + 0.51 lies outside.
  EXPECT_EQ(kept_columns(with_unseen(0.49F, {}, seen_but({})), 0.49F).size(), 8U);
  EXPECT_EQ(kept_columns(with_unseen(0.51F, {}, seen_but({})), 0.51F).size(), 7U);
}

TEST(DisparityMaskTest, MatchesOutsideTheLeftImageWereNotSeen) {
  EXPECT_TRUE(kept_columns(with_unseen(8.0F, {}, seen_but({})), 8.0F).empty());
  EXPECT_EQ(kept_columns(with_unseen(7.0F, {}, seen_but({})), 7.0F), (Columns{0}));
  EXPECT_EQ(kept_columns(with_unseen(-2.0F, {}, seen_but({})), -2.0F).size(), 6U);
  for (const float far : {1e9F, -1e9F, 1e30F, std::numeric_limits<float>::infinity()}) {
    EXPECT_TRUE(kept_columns(with_unseen(far, {}, seen_but({})), far).empty()) << far;
  }
}

TEST(DisparityMaskTest, AnEmptyMaskStandsForEverything) {
  for (const float value : {0.0F, 2.0F, 100.0F}) {
    EXPECT_EQ(kept_columns(with_unseen(value, {}, {}), value).size(), 8U);
    EXPECT_EQ(kept_columns(with_unseen(value, seen_but({1}), {}), value).size(), 7U);
  }
}

TEST(DisparityMaskTest, WhatHasNoDisparityStaysWithout) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const cv::Mat1b& mask : {cv::Mat1b(), seen_but({}), seen_but({0, 1, 2, 3, 4, 5, 6, 7})}) {
    EXPECT_TRUE(kept_columns(with_unseen(none, mask, mask), none).empty());
  }
  cv::Mat1f empty;
  discard_unseen(empty, {}, {});
  EXPECT_TRUE(empty.empty());
}

TEST(DisparityMaskProperty, APixelStaysIffBothCamerasSawIt) {
  std::mt19937 random(37);
  std::uniform_real_distribution<float> any(-4.0F, 24.0F);
  std::bernoulli_distribution often(0.7);
  for (int round = 0; round < 50; ++round) {
    cv::Mat1f before(9, 21);
    cv::Mat1b right(before.size());
    cv::Mat1b left(before.size());
    for (int i = 0; i < before.size().area(); ++i) {
      before(i / 21, i % 21) = any(random);
      right(i / 21, i % 21) = often(random) ? 255 : 0;
      left(i / 21, i % 21) = often(random) ? 255 : 0;
    }
    cv::Mat1f after = before.clone();
    discard_unseen(after, right, left);
    for (int i = 0; i < before.size().area(); ++i) {
      const int u = i % 21;
      const int v = i / 21;
      const long match = std::lround(static_cast<double>(u) + before(v, u));
      const bool expected =
          right(v, u) != 0 && match >= 0 && match < 21 && left(v, static_cast<int>(match)) != 0;
      EXPECT_EQ(!std::isnan(after(v, u)), expected) << u << ", " << v << ": " << before(v, u);
    }
  }
}

}  // namespace
}  // namespace skyhalo
