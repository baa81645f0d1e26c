#include "skyhalo/stereo/matcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::textured_pair;
using testing::TexturedPair;

MatcherConfig small_config(int paths = 3) {
  MatcherConfig config;
  config.max_disparity_px = 48;
  config.paths = paths;
  return config;
}

cv::Mat1f matched(const TexturedPair& pair, const MatcherConfig& config) {
  Matcher matcher(config);
  cv::Mat1f disparity;
  matcher.match(pair.left, pair.right, disparity);
  return disparity;
}

/// Share of the pixels in the first `columns` columns whose disparity is within 0.25 px of the
/// expected.
double share_right(const cv::Mat1f& disparity, int columns, double expected_px) {
  int right = 0;
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      right += std::abs(disparity(v, u) - expected_px) <= 0.25 ? 1 : 0;  // false for NaN
    }
  }
  return static_cast<double>(right) / (disparity.rows * columns);
}

int count_found(const cv::Mat1f& disparity) {
  return cv::countNonZero(disparity == disparity);
}

/// The pair as two cameras see it in a mirror: left and right change places.
TexturedPair mirrored(const TexturedPair& pair) {
  TexturedPair result;
  cv::flip(pair.right, result.left, 1);
  cv::flip(pair.left, result.right, 1);
  return result;
}

/// Two planes, one above the other.
TexturedPair two_planes(int upper_px, int lower_px, unsigned seed) {
  const TexturedPair upper = textured_pair({200, 40}, upper_px, seed);
  const TexturedPair lower = textured_pair({200, 40}, lower_px, seed + 1000);
  TexturedPair result;
  cv::vconcat(upper.left, lower.left, result.left);
  cv::vconcat(upper.right, lower.right, result.right);
  return result;
}

std::string refusal(const MatcherConfig& config) {
  return message_of([&] { (void)Matcher(config); });
}

TEST(MatcherTest, FindsThePlaneOfATexturedPair) {
  for (const int disparity_px : {1, 2, 5, 12, 23, 31, 46}) {
    const TexturedPair pair =
        textured_pair({220, 50}, disparity_px, static_cast<unsigned>(disparity_px));
    const cv::Mat1f disparity = matched(pair, small_config());
    ASSERT_EQ(disparity.size(), pair.right.size());
    EXPECT_GT(share_right(disparity, 220 - 48, disparity_px), 0.95) << disparity_px;
  }
}

TEST(MatcherTest, FindsItWithAnyNumberOfPaths) {
  for (const int paths : {3, 5, 8}) {
    const TexturedPair pair = textured_pair({220, 50}, 17, 3);
    EXPECT_GT(share_right(matched(pair, small_config(paths)), 220 - 48, 17), 0.95) << paths;
  }
}

TEST(MatcherTest, FindsNothingBeyondItsRange) {
  // A plane at 60 px is out of reach of a search up to 48.
  const TexturedPair pair = textured_pair({220, 50}, 60, 4);
  const cv::Mat1f disparity = matched(pair, small_config());
  EXPECT_LT(count_found(disparity), 220 * 50 / 20);
}

TEST(MatcherTest, FindsNothingInAnImageNarrowerThanTheRange) {
  for (const int width : {1, 20, 47, 48}) {
    const TexturedPair pair = textured_pair({width, 30}, 2, 5);
    const cv::Mat1f disparity = matched(pair, small_config());
    ASSERT_EQ(disparity.size(), cv::Size(width, 30));
    EXPECT_EQ(count_found(disparity), 0) << width;
  }
}

TEST(MatcherTest, TakesImagesThatAreJustWideEnough) {
  for (const int paths : {3, 5, 8}) {
    for (const int width : {49, 50, 52, 60}) {
      const TexturedPair pair = textured_pair({width, 30}, 2, 6);
      const cv::Mat1f disparity = matched(pair, small_config(paths));
      EXPECT_EQ(disparity.size(), cv::Size(width, 30));
      EXPECT_LE(count_found(disparity), (width - 48) * 30);
    }
  }
}

TEST(MatcherTest, FindsNothingNearWithoutTexture) {
  const cv::Mat1b plain(50, 220, static_cast<unsigned char>(90));
  const cv::Mat1f disparity = matched({plain, plain}, small_config());
  EXPECT_EQ(cv::countNonZero(disparity > 0.0), 0);
}

TEST(MatcherTest, ServesFrameAfterFrame) {
  Matcher matcher(small_config());
  cv::Mat1f disparity;
  for (const int disparity_px : {5, 20, 9}) {
    const cv::Size size(200 + disparity_px, 40);
    const TexturedPair pair = textured_pair(size, disparity_px, 7);
    matcher.match(pair.left, pair.right, disparity);
    ASSERT_EQ(disparity.size(), size);
    EXPECT_GT(share_right(disparity, size.width - 48, disparity_px), 0.95);
  }
}

TEST(MatcherTest, RefusesSettingsOutsideTheirDomain) {
  for (const int value : {-16, 0, 8, 17, 63, 272, 1024}) {
    MatcherConfig config;
    config.max_disparity_px = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.max_disparity_px"));
  }
  for (const int value : {-1, 0, 2, 4, 12, 13}) {
    MatcherConfig config;
    config.block_px = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.block_px"));
  }
}

TEST(MatcherTest, RefusesANumberOfPathsThatNoEngineHas) {
  for (const int value : {-3, 0, 1, 4, 6, 16}) {
    MatcherConfig config;
    config.paths = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.paths"));
  }
}

TEST(MatcherTest, RefusesChecksOutsideTheirDomain) {
  for (const int value : {-1, 101}) {
    MatcherConfig config;
    config.uniqueness_percent = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.uniqueness_percent"));
  }
  for (const int value : {-1, 0}) {
    MatcherConfig config;
    config.left_right_px = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.left_right_px"));
  }
}

TEST(MatcherTest, RefusesNegativeSpeckles) {
  MatcherConfig size;
  size.speckle_size_px = -1;
  EXPECT_THAT(refusal(size), HasSubstr("matching.speckle_size_px"));
  MatcherConfig range;
  range.speckle_range_px = -1;
  EXPECT_THAT(refusal(range), HasSubstr("matching.speckle_range_px"));
}

TEST(MatcherTest, AcceptsTheEndsOfTheDomains) {
  MatcherConfig low{.max_disparity_px = 16,
                    .block_px = 1,
                    .paths = 3,
                    .uniqueness_percent = 0,
                    .left_right_px = 1,
                    .speckle_size_px = 0,
                    .speckle_range_px = 0};
  EXPECT_NO_THROW((void)Matcher(low));
  MatcherConfig high{.max_disparity_px = 256,
                     .block_px = 11,
                     .paths = 8,
                     .uniqueness_percent = 100,
                     .left_right_px = 1000,
                     .speckle_size_px = 100000,
                     .speckle_range_px = 1000};
  EXPECT_NO_THROW((void)Matcher(high));
}

struct Agreement {
  int both = 0;  ///< pixels with a disparity here and in the mirror
  int same = 0;  ///< of these, with the same one
};

/// Mirrored, right pixel u is left pixel width - 1 - u, and rows keep their disparity.
Agreement compare_with_mirror(const cv::Mat1f& seen, const cv::Mat1f& in_mirror) {
  Agreement result;
  for (int v = 0; v < seen.rows; ++v) {
    for (int u = 0; u < seen.cols; ++u) {
      const double d_px = seen(v, u);
      const int mirrored_u =
          seen.cols - 1 - u - static_cast<int>(std::isnan(d_px) ? 0 : std::lround(d_px));
      if (std::isnan(d_px) || mirrored_u < 0 || std::isnan(in_mirror(v, mirrored_u))) {
        continue;
      }
      ++result.both;
      result.same += std::abs(in_mirror(v, mirrored_u) - d_px) <= 0.5 ? 1 : 0;
    }
  }
  return result;
}

TEST(MatcherProperty, AMirroredPairGivesTheMirroredDisparity) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const int upper_px = static_cast<int>(3 + 5 * seed);
    const int lower_px = static_cast<int>(2 + 7 * seed % 40);
    const TexturedPair pair = two_planes(upper_px, lower_px, seed);
    const Agreement found =
        compare_with_mirror(matched(pair, small_config()), matched(mirrored(pair), small_config()));
    EXPECT_GT(found.both, 200 * 80 / 3) << seed;
    EXPECT_GT(found.same, 0.99 * found.both) << seed;
  }
}

TEST(MatcherProperty, EveryDisparityLiesInTheRange) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    // Two unrelated textures: whatever is found must still be a disparity of the range.
    MatcherConfig config = small_config();
    config.uniqueness_percent = 0;
    config.speckle_size_px = 0;
    const cv::Mat1f disparity = matched(
        {testing::texture({160, 50}, seed), testing::texture({160, 50}, seed + 50)}, config);
    ASSERT_GT(count_found(disparity), 0);
    double least_px = 0.0;
    double most_px = 0.0;
    cv::minMaxLoc(disparity, &least_px, &most_px, nullptr, nullptr, disparity == disparity);
    EXPECT_GE(least_px, 0.0);
    EXPECT_LT(most_px, 48.0);
  }
}

TEST(MatcherProperty, TheSameInputGivesTheSameBits) {
  const TexturedPair pair = two_planes(10, 20, 9);
  Matcher matcher(small_config());
  cv::Mat1f first;
  cv::Mat1f second;
  matcher.match(pair.left, pair.right, first);
  matcher.match(pair.left, pair.right, second);
  EXPECT_EQ(cv::countNonZero(first == second), count_found(first));
  EXPECT_EQ(count_found(first), count_found(second));
  EXPECT_GT(count_found(first), 0);
}

}  // namespace
}  // namespace skyhalo
