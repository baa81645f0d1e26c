#include "skyhalo/sim/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace skyhalo {
namespace {

TEST(NoiseTest, ItHasItsMeanAndSpread) {
  const cv::Mat1f noise = fractal_noise({.side_px = 128, .cells_x = 4, .cells_y = 8}, 3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(noise, mean, deviation);
  EXPECT_NEAR(mean[0], 0.5, 1e-4);
  EXPECT_NEAR(deviation[0], 0.2, 1e-4);
}

TEST(NoiseTest, CellsOfALatticeAreCounted) {
  const CellNoise noise = cell_noise(64, 4, 9);
  double least = 0.0;
  cv::minMaxLoc(noise.border, &least);
  EXPECT_GE(least, 0.0);
  std::vector<float> tones(noise.tone.begin(), noise.tone.end());
  std::sort(tones.begin(), tones.end());
  const auto end = std::unique(tones.begin(), tones.end());
  EXPECT_LE(end - tones.begin(), 16);
  EXPECT_GE(end - tones.begin(), 12);
}

TEST(NoiseProperty, HillsAreSmoothBoundedAndTotal) {
  float before = hill_noise(-20.0F, 3.3F, 5);
  for (int i = -2000; i < 2000; ++i) {
    const float x = 0.01F * static_cast<float>(i);
    const float now = hill_noise(x, 3.3F, 5);
    EXPECT_LE(std::abs(now), 1.0F);
    EXPECT_LT(std::abs(now - before), 0.04F) << x;
    before = now;
  }
  EXPECT_EQ(hill_noise(std::numeric_limits<float>::quiet_NaN(), 0.0F, 5), 0.0F);
  EXPECT_EQ(hill_noise(0.0F, std::numeric_limits<float>::infinity(), 5), 0.0F);
}

}  // namespace
}  // namespace skyhalo
