#include "skyhalo/io/disparity_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace skyhalo {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(DisparityImageTest, TheUnitIsA256thOfAPixel) {
  const cv::Mat1f disparity = (cv::Mat1f(2, 3) << 1.0F, 12.5F, 63.0F, 0.25F, kNone, 100.0625F);
  const cv::Mat1w image = disparity_image(disparity);
  ASSERT_EQ(image.size(), cv::Size(3, 2));
  EXPECT_EQ(image(0, 0), 256);
  EXPECT_EQ(image(0, 1), 3200);
  EXPECT_EQ(image(0, 2), 16128);
  EXPECT_EQ(image(1, 0), 64);
  EXPECT_EQ(image(1, 1), 0);
  EXPECT_EQ(image(1, 2), 25616);
}

TEST(DisparityImageTest, UnitsAreRounded) {
  // 10.49 / 256 and 10.51 / 256.
  const cv::Mat1w image = disparity_image((cv::Mat1f(1, 2) << 0.0409765625F, 0.0410546875F));
  EXPECT_EQ(image(0, 0), 10);
  EXPECT_EQ(image(0, 1), 11);
}

TEST(DisparityImageTest, ZeroIsNoneSoThatTheLeastDisparityIsOne) {
  const cv::Mat1w image =
      disparity_image((cv::Mat1f(1, 5) << 0.0F, 0.0019F, -3.0F, -kInfinity, 1.0F / 256.0F));
  for (int u = 0; u < image.cols; ++u) {
    EXPECT_EQ(image(0, u), 1) << u;
  }
}

TEST(DisparityImageTest, WhatSixteenBitsDoNotHoldIsClipped) {
  const cv::Mat1f disparity =
      (cv::Mat1f(1, 5) << 255.99609375F, 256.0F, 4000.0F, kInfinity, 255.0F);
  const cv::Mat1w image = disparity_image(disparity);
  for (int u = 0; u < 4; ++u) {
    EXPECT_EQ(image(0, u), 65535) << u;
  }
  EXPECT_EQ(image(0, 4), 65280);
  EXPECT_EQ(clipped_count(disparity), 3) << "the first one is held exactly";
  EXPECT_EQ(clipped_count(cv::Mat1f(3, 3, kNone)), 0);
}

TEST(DisparityImageTest, APartOfAnImageIsAnImage) {
  cv::Mat1f whole(4, 6, 2.0F);
  whole(cv::Rect(1, 1, 3, 2)) = 5.0F;
  const cv::Mat1w image = disparity_image(whole(cv::Rect(1, 1, 3, 2)));
  ASSERT_EQ(image.size(), cv::Size(3, 2));
  EXPECT_EQ(cv::countNonZero(image != 1280), 0);
}

TEST(EnlargedDisparityTest, EachDisparityFillsItsBlock) {
  const cv::Mat1f shrunk = (cv::Mat1f(2, 2) << 4.0F, kNone, 1.5F, 0.0F);
  const cv::Mat1f disparity = enlarged_disparity(shrunk, 3, {6, 6});
  ASSERT_EQ(disparity.size(), cv::Size(6, 6));
  for (int v = 0; v < 3; ++v) {
    for (int u = 0; u < 3; ++u) {
      EXPECT_EQ(disparity(v, u), 12.0F);
      EXPECT_TRUE(std::isnan(disparity(v, u + 3)));
      EXPECT_EQ(disparity(v + 3, u), 4.5F);
      EXPECT_EQ(disparity(v + 3, u + 3), 0.0F);
    }
  }
}

TEST(EnlargedDisparityTest, WhatIsLeftOverHasNone) {
  const cv::Mat1f disparity = enlarged_disparity(cv::Mat1f(1, 2, 3.0F), 4, {11, 6});
  ASSERT_EQ(disparity.size(), cv::Size(11, 6));
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 11; ++u) {
      if (v < 4 && u < 8) {
        EXPECT_EQ(disparity(v, u), 12.0F) << u << " " << v;
      } else {
        EXPECT_TRUE(std::isnan(disparity(v, u))) << u << " " << v;
      }
    }
  }
}

TEST(EnlargedDisparityTest, TheFactorOneChangesNothing) {
  const cv::Mat1f disparity = (cv::Mat1f(2, 3) << 1.0F, 2.0F, 3.0F, 4.0F, 5.5F, 6.0F);
  EXPECT_EQ(cv::norm(enlarged_disparity(disparity, 1, {3, 2}), disparity, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace skyhalo
