#include "skyhalo/stereo/matcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "stereo/matcher_cases.hpp"
#include "stereo/sgm/planes.hpp"
#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::count_found;
using testing::first_difference;
using testing::for_each_engine;
using ::testing::HasSubstr;
using testing::matched;
using testing::message_of;
using testing::share_right;
using ::testing::StartsWith;
using testing::textured_pair;
using testing::TexturedPair;

std::string refusal(const MatcherConfig& config) {
  std::string message = message_of([&] { (void)Matcher(config); });
  EXPECT_EQ(message, message_of([&] { check(config); }));
  return message;
}

/// Refuses each of the values of a setting by the name of its key.
template <class Section, class Value>
void expect_refused(Section MatcherConfig::*section,
                    Value Section::*setting,
                    const std::string& key,
                    const std::vector<Value>& values) {
  for (const Value value : values) {
    MatcherConfig config;
    config.*section.*setting = value;
    EXPECT_THAT(refusal(config), StartsWith(key + ": expected ")) << value;
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MatcherTest, FindsThePlaneOfATexturedPair) {
  for_each_engine([](const MatcherConfig& config) {
    for (const int disparity_px : {1, 2, 5, 12, 23, 31, 46}) {
      const TexturedPair pair =
          textured_pair({220, 50}, disparity_px, static_cast<unsigned>(disparity_px));
      const cv::Mat1f disparity = matched(pair, config);
      ASSERT_EQ(disparity.size(), pair.right.size());
      EXPECT_GT(share_right(disparity, {0, 220 - 48}, disparity_px), 0.95) << disparity_px;
    }
  });
}

TEST(MatcherTest, AlignsWithTheLeftImageIfAskedTo) {
  for_each_engine([](MatcherConfig config) {
    config.alignment = Alignment::kLeft;
    // A square at disparity 20 before the ground at 4, at columns 100 to 139 of the left image.
    TexturedPair pair = textured_pair({220, 60}, 4, 1);
    const cv::Mat1b square = testing::texture({40, 60}, 2);
    square.copyTo(pair.left.colRange(100, 140));
    square.copyTo(pair.right.colRange(80, 120));
    const cv::Mat1f disparity = matched(pair, config);
    EXPECT_GT(share_right(disparity, {105, 135}, 20), 0.95);
    EXPECT_GT(share_right(disparity, {60, 80}, 4), 0.95);
    EXPECT_GT(share_right(disparity, {150, 210}, 4), 0.95);
    config.alignment = Alignment::kRight;
    EXPECT_GT(share_right(matched(pair, config), {85, 115}, 20), 0.95);
  });
}

TEST(MatcherTest, FindsLittleBeyondItsRange) {
  // A plane at 60 px is out of reach of a search up to 48.
  const TexturedPair pair = textured_pair({220, 50}, 60, 4);
  for_each_engine([&](const MatcherConfig& config) {
    const double most = config.kind == MatcherKind::kSgm ? 0.3 : 0.05;
    EXPECT_LT(testing::density(matched(pair, config)), most);
  });
}

TEST(MatcherTest, RefusesImagesNotWiderThanTheRange) {
  for_each_engine([](const MatcherConfig& config) {
    for (const int width : {1, 20, 47, 48}) {
      const TexturedPair pair = textured_pair({width, 30}, 2, 5);
      EXPECT_EQ(message_of([&] { (void)matched(pair, config); }),
                "stereo pair: images " + std::to_string(width) +
                    " px wide are too narrow to search 48 disparities");
    }
  });
}

TEST(MatcherTest, TakesImagesThatAreJustWideEnough) {
  for_each_engine([](MatcherConfig config) {
    for (const int paths : {3, 5, 8}) {
      config.opencv.paths = paths;
      for (const int width : {49, 50, 52, 60}) {
        const TexturedPair pair = textured_pair({width, 30}, 2, 6);
        EXPECT_EQ(matched(pair, config).size(), cv::Size(width, 30));
      }
    }
  });
}

TEST(MatcherTest, RefusesPairsThatAreNone) {
  for_each_engine([](const MatcherConfig& config) {
    const cv::Mat1b some = testing::texture({100, 30}, 1);
    const auto refused = [&](const cv::Mat& left, const cv::Mat& right) {
      Matcher matcher(config);
      cv::Mat1f disparity;
      return message_of([&] { matcher.match(left, right, disparity); });
    };
    EXPECT_THAT(refused(cv::Mat(), some), HasSubstr("empty"));
    EXPECT_THAT(refused(some, some.rowRange(0, 29)), HasSubstr("100x30"));
    cv::Mat wide;
    some.convertTo(wide, CV_16U);
    EXPECT_THAT(refused(wide, some), HasSubstr("differ in depth"));
    cv::Mat real;
    some.convertTo(real, CV_32F);
    EXPECT_THAT(refused(real, real), HasSubstr("expected grey or colour"));
  });
}

TEST(MatcherTest, FindsNothingNearWithoutTexture) {
  const cv::Mat1b plain(50, 220, static_cast<unsigned char>(90));
  for_each_engine([&](const MatcherConfig& config) {
    EXPECT_EQ(cv::countNonZero(matched({plain, plain}, config) > 0.0), 0);
  });
}

TEST(MatcherTest, ServesFrameAfterFrame) {
  for_each_engine([](const MatcherConfig& config) {
    Matcher matcher(config);
    cv::Mat1f disparity;
    for (const int disparity_px : {5, 20, 9, 9, 20}) {
      const cv::Size size(200 + disparity_px, 60 - disparity_px);
      const TexturedPair pair = textured_pair(size, disparity_px, 7);
      matcher.match(pair.left, pair.right, disparity);
      ASSERT_EQ(disparity.size(), size);
      EXPECT_GT(share_right(disparity, {0, size.width - 48}, disparity_px), 0.95);
      EXPECT_EQ(first_difference(disparity, matched(pair, config)), "");
    }
  });
}

TEST(MatcherTest, GoesOnAfterABadPair) {
  for_each_engine([](const MatcherConfig& config) {
    Matcher matcher(config);
    cv::Mat1f disparity;
    const TexturedPair pair = textured_pair({120, 40}, 5, 8);
    (void)message_of([&] { matcher.match(cv::Mat(), pair.right, disparity); });
    matcher.match(pair.left, pair.right, disparity);
    (void)message_of([&] { matcher.match(pair.left, cv::Mat(), disparity); });
    matcher.match(pair.left, pair.right, disparity);
    EXPECT_EQ(first_difference(disparity, matched(pair, config)), "");
  });
}

TEST(MatcherTest, RefusesARangeOutsideItsDomain) {
  for (const int value : {-16, 0, 8, 17, 63, 272, 1024}) {
    MatcherConfig config;
    config.max_disparity_px = value;
    EXPECT_THAT(refusal(config), StartsWith("matching.max_disparity_px: expected "));
  }
}

TEST(MatcherTest, RefusesPenaltiesOutsideTheirDomain) {
  const auto refused = [](int p1, int p2_min, int p2_max) {
    MatcherConfig config;
    config.sgm.p1 = p1;
    config.sgm.p2_min = p2_min;
    config.sgm.p2_max = p2_max;
    return refusal(config);
  };
  EXPECT_THAT(refused(-1, 4, 50), StartsWith("sgm.p1: expected "));
  EXPECT_THAT(refused(5, 4, 50), StartsWith("sgm.p2_min: expected "));
  EXPECT_THAT(refused(4, 20, 19), StartsWith("sgm.p2_max: expected "));
  EXPECT_THAT(refused(4, 4, 52), StartsWith("sgm.p2_max: expected "));
  EXPECT_THAT(refused(0, -1, 50), StartsWith("sgm.p2_min: expected "));
  EXPECT_THAT(refused(52, 52, 52), StartsWith("sgm.p2_max: expected "));
}

TEST(MatcherTest, RefusesSgmSettingsOutsideTheirDomain) {
  const auto sgm = &MatcherConfig::sgm;
  expect_refused(sgm, &SgmConfig::uniqueness_percent, "sgm.uniqueness_percent", {-1, 101});
  expect_refused(sgm, &SgmConfig::left_right_px, "sgm.left_right_px", {-0.01, 256.5, kNan});
  expect_refused(sgm, &SgmConfig::texture_min_grey, "sgm.texture_min_grey", {-1, 256});
  expect_refused(sgm, &SgmConfig::repetition_px, "sgm.repetition_px", {-1, 0, 83});
  expect_refused(sgm, &SgmConfig::median_passes, "sgm.median_passes", {-1, 11});
  expect_refused(sgm, &SgmConfig::fill_min_px, "sgm.fill_min_px", {-1, 0, 27});
  expect_refused(sgm, &SgmConfig::speckle_size_px, "sgm.speckle_size_px", {-1});
  expect_refused(sgm, &SgmConfig::speckle_step_px, "sgm.speckle_step_px", {-0.01, 257.0, kNan});
  expect_refused(sgm, &SgmConfig::edge_step_px, "sgm.edge_step_px", {-0.01, 257.0, kNan});
}

TEST(MatcherTest, RefusesOpencvSettingsOutsideTheirDomain) {
  using Config = OpencvSgbmConfig;
  const auto opencv = &MatcherConfig::opencv;
  expect_refused(opencv, &Config::block_px, "opencv.block_px", {-1, 0, 2, 4, 12, 13});
  expect_refused(opencv, &Config::paths, "opencv.paths", {-3, 0, 1, 4, 6, 16});
  expect_refused(opencv, &Config::uniqueness_percent, "opencv.uniqueness_percent", {-1, 101});
  expect_refused(opencv, &Config::left_right_px, "opencv.left_right_px", {-1, 0});
  expect_refused(opencv, &Config::speckle_size_px, "opencv.speckle_size_px", {-1});
  expect_refused(opencv, &Config::speckle_range_px, "opencv.speckle_range_px", {-1});
}

MatcherConfig least_config() {
  return {.max_disparity_px = 16,
          .sgm = {.p1 = 0,
                  .p2_min = 0,
                  .p2_max = 0,
                  .uniqueness_percent = 0,
                  .left_right_px = 0.0,
                  .texture_min_grey = 0,
                  .repetition_px = 82,
                  .median_passes = 0,
                  .fill_min_px = 1,
                  .speckle_size_px = 0,
                  .speckle_step_px = 0.0,
                  .edge_step_px = 0.0},
          .opencv = {.block_px = 1,
                     .paths = 3,
                     .uniqueness_percent = 0,
                     .left_right_px = 1,
                     .speckle_size_px = 0,
                     .speckle_range_px = 0}};
}

MatcherConfig largest_config() {
  return {.max_disparity_px = 256,
          .sgm = {.p1 = 51,
                  .p2_min = 51,
                  .p2_max = 51,
                  .uniqueness_percent = 100,
                  .left_right_px = 256.0,
                  .texture_min_grey = 255,
                  .repetition_px = 1,
                  .median_passes = 10,
                  .fill_min_px = 26,
                  .speckle_size_px = std::numeric_limits<int>::max(),
                  .speckle_step_px = 256.0,
                  .edge_step_px = 256.0},
          .opencv = {.block_px = 11,
                     .paths = 8,
                     .uniqueness_percent = 100,
                     .left_right_px = 1000,
                     .speckle_size_px = 100'000,
                     .speckle_range_px = 1000}};
}

TEST(MatcherTest, WorksAtTheEndsOfTheDomains) {
  const TexturedPair pair = textured_pair({300, 20}, 5, 9);
  for (MatcherConfig config : {least_config(), largest_config()}) {
    for (const MatcherKind kind : {MatcherKind::kSgm, MatcherKind::kOpencv}) {
      config.kind = kind;
      EXPECT_EQ(matched(pair, config).size(), pair.left.size());
    }
  }
  // Only what is not between two pixels agrees with the other direction to the bit.
  MatcherConfig tolerant = least_config();
  tolerant.sgm.p1 = SgmConfig().p1;  // without penalties every pixel is for itself
  tolerant.sgm.p2_min = SgmConfig().p2_min;
  tolerant.sgm.p2_max = SgmConfig().p2_max;
  tolerant.sgm.left_right_px = 0.5;
  EXPECT_GT(share_right(matched(pair, tolerant), {0, 280}, 5), 0.9);
}

TEST(MatcherProperty, TheMirroredPairAlignedLeftGivesTheMirroredDisparity) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const TexturedPair pair = testing::two_planes(
        static_cast<int>(3 + 5 * seed), static_cast<int>(2 + 7 * seed % 40), seed);
    for_each_engine([&](MatcherConfig config) {
      const cv::Mat1f seen = matched(pair, config);
      config.alignment = Alignment::kLeft;
      cv::Mat1f back;
      cv::flip(matched(testing::mirrored(pair), config), back, 1);
      EXPECT_EQ(first_difference(back, seen), "");
      EXPECT_GT(testing::density(seen), 0.5);
    });
  }
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

TEST(MatcherProperty, AMirroredPairGivesTheDisparityOfItsMatches) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const TexturedPair pair = testing::two_planes(
        static_cast<int>(3 + 5 * seed), static_cast<int>(2 + 7 * seed % 40), seed);
    for_each_engine([&](const MatcherConfig& config) {
      const Agreement found =
          compare_with_mirror(matched(pair, config), matched(testing::mirrored(pair), config));
      EXPECT_GT(found.both, 200 * 80 / 3) << seed;
      EXPECT_GT(found.same, 0.99 * found.both) << seed;
    });
  }
}

TEST(MatcherProperty, EveryDisparityLiesInTheRangeAndInTheOtherImage) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    // Two unrelated textures: whatever is found must still be a disparity of the range.
    for_each_engine([&](MatcherConfig config) {
      config.sgm.uniqueness_percent = 0;
      config.sgm.speckle_size_px = 0;
      config.sgm.left_right_px = 256.0;
      config.opencv.uniqueness_percent = 0;
      config.opencv.speckle_size_px = 0;
      const cv::Mat1f disparity = matched(
          {testing::texture({160, 50}, seed), testing::texture({160, 50}, seed + 50)}, config);
      ASSERT_GT(count_found(disparity), 0);
      for (int v = 0; v < disparity.rows; ++v) {
        for (int u = 0; u < disparity.cols; ++u) {
          const float d_px = disparity(v, u);
          ASSERT_TRUE(std::isnan(d_px) || (d_px >= 0.0F && d_px < 48.0F)) << d_px;
          ASSERT_TRUE(std::isnan(d_px) || static_cast<float>(u) + d_px <= 159.0F) << d_px;
        }
      }
    });
  }
}

TEST(MatcherProperty, TheSameInputGivesTheSameBits) {
  const TexturedPair pair = testing::two_planes(10, 20, 9);
  for_each_engine([&](const MatcherConfig& config) {
    Matcher matcher(config);
    cv::Mat1f first;
    cv::Mat1f second;
    matcher.match(pair.left, pair.right, first);
    matcher.match(pair.left, pair.right, second);
    EXPECT_EQ(first_difference(first, second), "");
    EXPECT_GT(count_found(first), 0);
  });
}

TEST(MatcherProperty, ViewsGiveTheBitsOfTheirClones) {
  const TexturedPair larger = testing::two_planes(10, 20, 10);
  for_each_engine([&](MatcherConfig config) {
    for (const Alignment alignment : {Alignment::kRight, Alignment::kLeft}) {
      config.alignment = alignment;
      for (const cv::Rect& at : {cv::Rect(1, 3, 100, 61), cv::Rect(17, 0, 183, 80)}) {
        const TexturedPair clones{larger.left(at).clone(), larger.right(at).clone()};
        const cv::Mat1f found = matched({larger.left(at), larger.right(at)}, config);
        EXPECT_EQ(first_difference(found, matched(clones, config)), "");
      }
    }
  });
}

TEST(MatcherProperty, AViewOfADisparityIsFilledInPlace) {
  const TexturedPair pair = textured_pair({100, 40}, 6, 11);
  for_each_engine([&](const MatcherConfig& config) {
    cv::Mat1f memory(42, 130, 77.0F);
    const cv::Rect at(7, 1, 100, 40);
    cv::Mat1f view = memory(at);
    Matcher matcher(config);
    matcher.match(pair.left, pair.right, view);
    EXPECT_EQ(first_difference(cv::Mat1f(memory(at)), matched(pair, config)), "");
    view = 77.0F;
    EXPECT_EQ(cv::countNonZero(memory == 77.0F), 42 * 130);
  });
}

}  // namespace
}  // namespace skyhalo
