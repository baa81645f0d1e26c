#include "skyhalo/sim/procedural_texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

cv::Mat1b grey(Pattern pattern, std::uint64_t seed) {
  cv::Mat1b picture;
  cv::cvtColor(procedural_texture(pattern, seed), picture, cv::COLOR_BGR2GRAY);
  return picture;
}

/// Mean difference between a column and the next one, where the last is before the first.
double column_difference(const cv::Mat1b& picture, int col) {
  double sum = 0.0;
  for (int row = 0; row < picture.rows; ++row) {
    sum += std::abs(picture(row, col) - picture(row, (col + 1) % picture.cols));
  }
  return sum / picture.rows;
}

/// The greatest and the mean difference among neighbouring columns in the picture's inside.
std::pair<double, double> differences(const cv::Mat1b& picture) {
  double greatest = 0.0;
  double sum = 0.0;
  for (int col = 0; col + 1 < picture.cols; ++col) {
    greatest = std::max(greatest, column_difference(picture, col));
    sum += column_difference(picture, col);
  }
  return {greatest, sum / (picture.cols - 1)};
}

double spread(const cv::Mat& picture) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture, mean, deviation);
  return deviation[0];
}

TEST(ProceduralTextureProperty, EveryPatternWrapsAtBothEdges) {
  for (int i = 0; i < kPatternCount; ++i) {
    const cv::Mat1b picture = grey(static_cast<Pattern>(i), 3);
    for (const cv::Mat1b& turned : {picture, cv::Mat1b(picture.t())}) {
      // A seam would stand out from the steps inside.
      EXPECT_LE(column_difference(turned, turned.cols - 1), 1.2 * differences(turned).first) << i;
    }
  }
}

TEST(ProceduralTextureProperty, TheSameSeedGivesTheSamePictureAnotherOneNot) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  for (int i = 0; i < kPatternCount; ++i) {
    const auto pattern = static_cast<Pattern>(i);
    const cv::Mat3b picture = procedural_texture(pattern, 3);
    EXPECT_EQ(cv::norm(picture, procedural_texture(pattern, 3), cv::NORM_INF), 0.0) << i;
    EXPECT_GT(cv::norm(picture, procedural_texture(pattern, 4), cv::NORM_INF), 0.0) << i;
    EXPECT_EQ(picture.rows, picture.cols);
    EXPECT_TRUE(picture.rows == 512 || picture.rows == 1024) << i;
  }
}

TEST(ProceduralTextureProperty, ContrastGoesFromPixelsToTheWholePicture) {
  for (int i = 0; i < kPatternCount; ++i) {
    const auto pattern = static_cast<Pattern>(i);
    if (pattern == Pattern::kPaint || pattern == Pattern::kClouds) {
      continue;
    }
    const cv::Mat1b picture = grey(pattern, 3);
    EXPECT_GT(differences(picture).second, 2.0) << i;
    cv::Mat1b smaller = picture;
    for (int side = picture.cols / 8; side >= 16; side /= 4) {
      cv::resize(picture, smaller, {side, side}, 0.0, 0.0, cv::INTER_AREA);
      EXPECT_GT(spread(smaller), 4.0) << i << " at " << side;
    }
  }
}

TEST(ProceduralTextureTest, PaintIsNearlyBlankAndCloudsAreGrey) {
  EXPECT_LT(spread(grey(Pattern::kPaint, 3)), 2.0);
  EXPECT_LT(differences(grey(Pattern::kPaint, 3)).second, 0.5);
  for (const cv::Vec3b& pixel : procedural_texture(Pattern::kClouds, 3)) {
    ASSERT_TRUE(pixel[0] == pixel[1] && pixel[1] == pixel[2]);
  }
}

}  // namespace
}  // namespace skyhalo
