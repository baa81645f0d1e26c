#include "skyhalo/stereo/sgm_matcher.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <random>
#include <utility>

#include "stereo/matcher_cases.hpp"
#include "stereo/sgm/planes.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::count_found;
using testing::density;
using testing::first_difference;
using testing::textured_pair;
using testing::TexturedPair;

cv::Mat1f next_of(SgmMatcher& matcher, const TexturedPair& pair) {
  cv::Mat1f disparity;
  matcher.match(pair.left, pair.right, disparity);
  return disparity;
}

cv::Mat1f disparity_of(const TexturedPair& pair, const MatcherConfig& config = {}) {
  SgmMatcher matcher(config);
  return next_of(matcher, pair);
}

/// The ground at 8 px, before it squares at 20 and 33 px.
TexturedPair scene(unsigned seed) {
  TexturedPair pair = textured_pair({320, 120}, 8, seed);
  for (const int d_px : {20, 33}) {
    const cv::Mat1b square = testing::texture({50, 50}, seed + static_cast<unsigned>(d_px));
    square.copyTo(pair.left(cv::Rect(6 * d_px, d_px, 50, 50)));
    square.copyTo(pair.right(cv::Rect(5 * d_px, d_px, 50, 50)));
  }
  return pair;
}

TEST(SgmMatcherTest, NoBandOfColumnsIsMissing) {
  // The match of right pixel u is left pixel u + 20: it lies in the left image up to u = 299.
  const TexturedPair pair = textured_pair({320, 60}, 20, 1);
  MatcherConfig config;
  const cv::Mat1f disparity = disparity_of(pair, config);
  for (int u = 0; u < 299; ++u) {
    EXPECT_GT(testing::share_right(disparity, {u, u + 1}, 20), 0.95) << u;
  }
  config.alignment = Alignment::kLeft;
  const cv::Mat1f aligned_left = disparity_of(pair, config);
  for (int u = 21; u < 320; ++u) {
    EXPECT_GT(testing::share_right(aligned_left, {u, u + 1}, 20), 0.95) << u;
  }
}

TEST(SgmMatcherTest, MovesWithItsMemory) {
  SgmMatcher first({});
  const cv::Mat1f expected = next_of(first, scene(1));
  SgmMatcher second(std::move(first));
  EXPECT_EQ(first_difference(next_of(second, scene(1)), expected), "");
  SgmMatcher third({});
  third = std::move(second);
  EXPECT_EQ(first_difference(next_of(third, scene(1)), expected), "");
}

TEST(SgmMatcherTest, FollowsTheInstructionSetInUse) {
  SgmMatcher matcher({});
  const cv::Mat1f expected = next_of(matcher, scene(2));
  testing::for_each_instruction_set(
      [&] { EXPECT_EQ(first_difference(next_of(matcher, scene(2)), expected), ""); });
  EXPECT_EQ(first_difference(next_of(matcher, scene(2)), expected), "");
}

TEST(SgmMatcherTest, FindsNothingWithoutTexture) {
  for (const int level : {0, 90, 255}) {
    const cv::Mat1b plain(60, 220, static_cast<std::uint8_t>(level));
    EXPECT_EQ(count_found(disparity_of({plain, plain})), 0);
  }
}

/// Stripes of a period of 16 px at a disparity: they fit at four disparities of the range.
TexturedPair stripes(const cv::Size& size, int disparity_px) {
  cv::Mat1b wide(size.height, size.width + disparity_px);
  for (int u = 0; u < wide.cols; ++u) {
    wide.col(u) = static_cast<std::uint8_t>(128.0 + 100.0 * std::sin(u * 2.0 * CV_PI / 16.0));
  }
  return {wide.colRange(0, size.width).clone(), wide.colRange(disparity_px, wide.cols).clone()};
}

/// A net: one tile again and again, each image with noise of its own.
TexturedPair net(const cv::Size& size, int period_px, int disparity_px) {
  const cv::Mat1b tile = testing::texture({period_px, period_px}, 5);
  cv::Mat1b wide;
  cv::repeat(tile, size.height / period_px + 1, (size.width + disparity_px) / period_px + 1, wide);
  cv::RNG random(6);
  const auto seen_from = [&](int u) {
    cv::Mat1b noise(size);
    random.fill(noise, cv::RNG::UNIFORM, 0, 4);
    return cv::Mat1b(wide(cv::Rect(cv::Point(u, 0), size)) + noise);
  };
  cv::Mat1b left = seen_from(0);
  return {left, seen_from(disparity_px)};
}

/// Of the columns whose whole search range of 64 px lies within the other image: beyond, too few
/// repetitions are left to be seen as such.
double found_share(const cv::Mat1f& disparity) {
  const cv::Mat1f whole_range = disparity.colRange(0, disparity.cols - 64);
  return static_cast<double>(cv::countNonZero(whole_range == whole_range)) /
         static_cast<double>(whole_range.total());
}

TEST(SgmMatcherTest, NothingIsFoundInStripes) {
  EXPECT_LT(found_share(disparity_of(stripes({320, 80}, 24))), 0.02);
}

TEST(SgmMatcherTest, NothingIsFoundInNets) {
  for (const int period_px : {6, 8, 12}) {
    EXPECT_LT(found_share(disparity_of(net({320, 96}, period_px, 28))), 0.05) << period_px;
  }
}

TEST(SgmMatcherTest, AFenceInASceneGivesNoWrongDistance) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    TexturedPair pair = textured_pair({320, 160}, 24, seed);
    const cv::Rect middle(0, 40, 320, 80);
    const TexturedPair fence = stripes(middle.size(), 24);
    fence.left.copyTo(pair.left(middle));
    fence.right.copyTo(pair.right(middle));
    const cv::Mat1f disparity = disparity_of(pair);
    EXPECT_GT(testing::share_right(disparity(cv::Rect(0, 0, 320, 36)), {0, 320 - 24}, 24), 0.9);
    const cv::Mat1f inside = disparity(middle).colRange(0, 320 - 64);
    const int wrong = cv::countNonZero((inside < 23.0F) | (inside > 25.0F));  // not so for NaN
    EXPECT_LT(wrong, static_cast<int>(inside.total() / 50)) << seed;
  }
}

TEST(SgmMatcherTest, FindsNothingWithinABlankWall) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    // A wall of 100 x 80 px before the ground, without anything on it.
    TexturedPair pair = textured_pair({320, 140}, 8, seed);
    const cv::Rect in_right(100, 30, 100, 80);
    pair.right(in_right) = 130;
    pair.left(in_right + cv::Point(15, 0)) = 130;
    const cv::Mat1f disparity = disparity_of(pair);
    const cv::Rect within(110, 40, 80, 60);
    EXPECT_EQ(count_found(disparity(within)), 0) << seed;
    EXPECT_GT(testing::share_right(disparity, {0, 80}, 8), 0.95) << seed;
  }
}

TEST(SgmMatcherTest, FindsLittleInUnrelatedImages) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const TexturedPair noise{testing::random_grey({320, 120}, 0, 255, random),
                             testing::random_grey({320, 120}, 0, 255, random)};
    EXPECT_LT(density(disparity_of(noise)), 0.15) << seed;
    const TexturedPair textures{testing::texture({320, 120}, seed),
                                testing::texture({320, 120}, seed + 100)};
    EXPECT_LT(density(disparity_of(textures)), 0.25) << seed;
  }
}

TEST(SgmMatcherProperty, TheSameBitsWithAnyNumberOfThreads) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    for (const Alignment alignment : {Alignment::kRight, Alignment::kLeft}) {
      MatcherConfig config;
      config.alignment = alignment;
      cv::Mat1f alone;
      {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        alone = disparity_of(scene(seed), config);
      }
      const tbb::global_control several(tbb::global_control::max_allowed_parallelism, 2);
      EXPECT_EQ(first_difference(disparity_of(scene(seed), config), alone), "");
      EXPECT_GT(density(alone), 0.5);
    }
  }
}

TEST(SgmMatcherProperty, AFrameLeavesNoTraceInTheNext) {
  SgmMatcher matcher({});
  for (unsigned seed = 1; seed <= 8; ++seed) {
    TexturedPair pair = scene(seed);
    if (seed % 3 == 0) {
      pair = {pair.left.rowRange(0, 70), pair.right.rowRange(0, 70)};
    }
    EXPECT_EQ(first_difference(next_of(matcher, pair), disparity_of(pair)), "") << seed;
  }
}

}  // namespace
}  // namespace skyhalo
