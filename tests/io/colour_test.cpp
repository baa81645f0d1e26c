#include "skyhalo/io/colour.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skyhalo {
namespace {

/// Linear light of an sRGB channel (IEC 61966-2-1).
double linear(unsigned char channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// CIE lightness, 0 for black to 100 for white.
double lightness(const cv::Vec3b& bgr) {
  const double y = 0.0722 * linear(bgr[0]) + 0.7152 * linear(bgr[1]) + 0.2126 * linear(bgr[2]);
  return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : y * 24389.0 / 27.0;
}

TEST(ColourTest, LightnessIsThatOfKnownColours) {
  EXPECT_NEAR(lightness({255, 255, 255}), 100.0, 1e-9);
  EXPECT_NEAR(lightness({0, 0, 0}), 0.0, 1e-9);
  EXPECT_NEAR(lightness({0, 0, 255}), 53.24, 0.01);  // pure red
}

TEST(ColourTest, RunsFromDarkBlueToYellow) {
  const cv::Vec3b low = scale_colour(0.0);
  EXPECT_GT(low[0], low[1]);
  EXPECT_GT(low[0], low[2]);
  EXPECT_LT(lightness(low), 25.0);
  const cv::Vec3b high = scale_colour(1.0);
  EXPECT_LT(high[0], 100);
  EXPECT_GT(high[1], 200);
  EXPECT_GT(high[2], 200);
}

TEST(ColourTest, LightnessRisesSteadily) {
  // "Steadily": each of 20 steps rises, none by more than three times the mean step.
  constexpr int kSteps = 20;
  const double mean = (lightness(scale_colour(1.0)) - lightness(scale_colour(0.0))) / kSteps;
  ASSERT_GT(mean, 2.0);
  for (int i = 0; i < kSteps; ++i) {
    const double rise = lightness(scale_colour((i + 1.0) / kSteps)) -
                        lightness(scale_colour(static_cast<double>(i) / kSteps));
    EXPECT_GT(rise, 0.0) << i;
    EXPECT_LT(rise, 3.0 * mean) << i;
  }
}

TEST(ColourTest, SharesOutsideAreClamped) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(scale_colour(-3.0), scale_colour(0.0));
  EXPECT_EQ(scale_colour(-kInfinity), scale_colour(0.0));
  EXPECT_EQ(scale_colour(1.5), scale_colour(1.0));
  EXPECT_EQ(scale_colour(kInfinity), scale_colour(1.0));
  EXPECT_EQ(scale_colour(std::numeric_limits<double>::quiet_NaN()), scale_colour(0.0));
  EXPECT_NE(scale_colour(0.0), scale_colour(1.0));
}

TEST(ColourProperty, NeighbouringSharesHaveNeighbouringColours) {
  for (int i = 0; i < 1000; ++i) {
    const cv::Vec3b a = scale_colour(i / 1000.0);
    const cv::Vec3b b = scale_colour((i + 1) / 1000.0);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_LE(std::abs(a[channel] - b[channel]), 2) << i;
    }
  }
}

}  // namespace
}  // namespace skyhalo
