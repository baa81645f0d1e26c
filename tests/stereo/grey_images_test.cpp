#include "skyhalo/stereo/grey_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "skyhalo/stereo/matcher.hpp"
#include "stereo/sgm/planes.hpp"
#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using ::testing::HasSubstr;
using testing::TexturedPair;

std::string refusal(const cv::Mat& left, const cv::Mat& right) {
  return testing::message_of([&] { GreyImages().convert(left, right); });
}

cv::Mat image_of(int type, cv::Size size = {20, 10}) {
  return cv::Mat::zeros(size, type);
}

/// One row of 16-bit levels, and the same in the other image.
cv::Mat1b narrowed(const cv::Mat1w& levels) {
  GreyImages grey;
  grey.convert(levels, levels);
  EXPECT_EQ(first_difference(grey.left(), grey.right()), "");
  return grey.left().clone();
}

TEST(GreyImagesTest, RefusesEmptyImages) {
  const cv::Mat some = image_of(CV_8UC1);
  EXPECT_THAT(refusal(cv::Mat(), some), HasSubstr("stereo pair: an image is empty"));
  EXPECT_THAT(refusal(some, cv::Mat()), HasSubstr("stereo pair: an image is empty"));
  EXPECT_THAT(refusal(cv::Mat(), cv::Mat()), HasSubstr("stereo pair: an image is empty"));
  EXPECT_THAT(refusal(cv::Mat1b(0, 20), cv::Mat1b(0, 20)), HasSubstr("empty"));
}

TEST(GreyImagesTest, RefusesImagesOfTwoSizes) {
  const cv::Mat some = image_of(CV_8UC1, {20, 10});
  EXPECT_THAT(refusal(some, image_of(CV_8UC1, {21, 10})),
              HasSubstr("stereo pair: the left image is 20x10, the right 21x10"));
  EXPECT_THAT(refusal(image_of(CV_8UC1, {20, 9}), some),
              HasSubstr("stereo pair: the left image is 20x9, the right 20x10"));
}

TEST(GreyImagesTest, RefusesImagesOfTwoTypes) {
  for (const int type : {CV_8UC3, CV_8UC4, CV_16UC1, CV_8SC1, CV_32FC1}) {
    EXPECT_THAT(refusal(image_of(CV_8UC1), image_of(type)),
                HasSubstr("stereo pair: the images differ in depth or channels"));
  }
}

TEST(GreyImagesTest, RefusesWhatNoCameraGives) {
  for (const int type : {CV_8SC1,
                         CV_16SC1,
                         CV_32SC1,
                         CV_32FC1,
                         CV_64FC1,
                         CV_32FC3,
                         CV_16FC1,
                         CV_8UC2,
                         CV_16UC2,
                         CV_8UC(5)}) {
    EXPECT_THAT(refusal(image_of(type), image_of(type)),
                HasSubstr("stereo pair: expected grey or colour of 8 or 16 bits"))
        << type;
  }
}

TEST(GreyImagesTest, RefusesMoreThanTwoDimensions) {
  const std::array<int, 3> sizes{4, 5, 6};
  const cv::Mat block(3, sizes.data(), CV_8UC1, cv::Scalar(1));
  EXPECT_THAT(refusal(block, block), HasSubstr("two dimensions"));
  EXPECT_THAT(refusal(image_of(CV_8UC1), block), HasSubstr("two dimensions"));
}

TEST(GreyImagesTest, PassesGreyImagesOn) {
  const cv::Mat1b left = testing::texture({30, 20}, 1);
  const cv::Mat1b right = testing::texture({40, 20}, 2).colRange(5, 35);
  GreyImages grey;
  grey.convert(left, right);
  EXPECT_EQ(grey.left().data, left.data);
  EXPECT_EQ(grey.right().data, right.data);
  EXPECT_EQ(grey.right().step1(), 40U);
}

TEST(GreyImagesTest, WeighsColoursAsTheEyeDoes) {
  // 0.114 blue + 0.587 green + 0.299 red.
  for (const int channels : {3, 4}) {
    cv::Mat bgr(2, 2, CV_8UC(channels), cv::Scalar(200, 100, 50, 255));
    GreyImages grey;
    grey.convert(bgr, bgr);
    EXPECT_NEAR(grey.left()(1, 1), 22.8 + 58.7 + 14.95, 1.0);
    EXPECT_NEAR(grey.right()(0, 0), 22.8 + 58.7 + 14.95, 1.0);
  }
}

TEST(GreyImagesTest, WideColoursBecomeGreyToo) {
  for (const int channels : {3, 4}) {
    cv::Mat left(1, 2, CV_16UC(channels), cv::Scalar::all(1000));
    cv::Mat right(1, 2, CV_16UC(channels), cv::Scalar::all(1100));
    GreyImages grey;
    grey.convert(left, right);
    EXPECT_EQ(grey.right()(0, 1) - grey.left()(0, 1), 100);
  }
}

TEST(GreyImagesTest, SixteenBitsKeepTheirStepsIfEightHoldThem) {
  const cv::Mat1w levels = (cv::Mat1w(1, 5) << 40000, 40001, 40010, 40254, 40255);
  const cv::Mat1b expected = (cv::Mat1b(1, 5) << 0, 1, 10, 254, 255);
  EXPECT_EQ(first_difference(narrowed(levels), expected), "");
}

TEST(GreyImagesTest, RarePixelsKeepTheirStepsToo) {
  // A single dark pixel and a single bright one among thousands, 255 levels apart.
  cv::Mat1w levels(50, 100, std::uint16_t{1100});
  levels(3, 4) = 1000;
  levels(3, 5) = 1003;
  levels(30, 40) = 1255;
  levels(30, 41) = 1250;
  const cv::Mat1b grey = narrowed(levels);
  EXPECT_EQ(grey(3, 5) - grey(3, 4), 3);
  EXPECT_EQ(grey(0, 0) - grey(3, 4), 100);
  EXPECT_EQ(grey(30, 40) - grey(30, 41), 5);
  EXPECT_EQ(grey(30, 40) - grey(0, 0), 155);
}

TEST(GreyImagesTest, WiderRangesAreSpreadOverEightBits) {
  cv::Mat1w ramp(64, 64);  // 12 bits, each level once
  for (int i = 0; i < 4096; ++i) {
    ramp(i / 64, i % 64) = static_cast<std::uint16_t>(i);
  }
  const cv::Mat1b grey = narrowed(ramp);
  EXPECT_EQ(grey(0, 0), 0);
  EXPECT_EQ(grey(63, 63), 255);
  // Rounded down, and the darkest four levels, which are a thousandth, are all black.
  for (int i = 0; i < 4096; ++i) {
    EXPECT_NEAR(grey(i / 64, i % 64), i * 255.0 / 4095.0, 1.3) << i;
    EXPECT_GE(grey(i / 64, i % 64), i == 0 ? 0 : grey((i - 1) / 64, (i - 1) % 64));
  }
}

TEST(GreyImagesTest, AThousandthOfThePixelsDoesNotSetTheRange) {
  cv::Mat1w levels(100, 100);
  for (int i = 0; i < 10'000; ++i) {
    levels(i / 100, i % 100) = static_cast<std::uint16_t>(10'000 + i % 1000);
  }
  for (int i = 0; i < 4; ++i) {
    levels(50, 10 * i) = 0;
    levels(60, 10 * i) = 65535;
  }
  const cv::Mat1b grey = narrowed(levels);
  EXPECT_EQ(grey(50, 0), 0);
  EXPECT_EQ(grey(60, 0), 255);
  EXPECT_NEAR(grey(70, 50), 127.5 - 115.0, 3.0);  // the level 10050 of 10000...10999
  EXPECT_LT(grey(0, 10), 5);
  EXPECT_GT(grey(9, 90), 250);
}

TEST(GreyImagesTest, BothImagesAreNarrowedByOneRule) {
  const cv::Mat1w dark(10, 10, std::uint16_t{1000});
  const cv::Mat1w bright(10, 10, std::uint16_t{1200});
  GreyImages grey;
  grey.convert(dark, bright);
  EXPECT_EQ(grey.right()(5, 5) - grey.left()(5, 5), 200);
}

TEST(GreyImagesTest, OneLevelEverywhereStaysOne) {
  for (const int level : {0, 1, 300, 65535}) {
    const cv::Mat1w plain(6, 7, static_cast<std::uint16_t>(level));
    const cv::Mat1b grey = narrowed(plain);
    EXPECT_EQ(cv::countNonZero(grey != grey(0, 0)), 0);
  }
}

TEST(GreyImagesTest, ServesPairsOfEveryKindInTurn) {
  GreyImages grey;
  const cv::Mat1b plain = testing::texture({30, 20}, 3);
  cv::Mat colour;
  cv::cvtColor(plain, colour, cv::COLOR_GRAY2BGR);
  cv::Mat wide;
  plain.convertTo(wide, CV_16U);
  for (int round = 0; round < 2; ++round) {
    grey.convert(colour, colour);
    EXPECT_EQ(first_difference(grey.left(), plain), "");
    grey.convert(wide, wide);
    EXPECT_EQ(grey.right().size(), plain.size());
    grey.convert(plain, plain);
    EXPECT_EQ(first_difference(grey.right(), plain), "");
  }
  EXPECT_EQ(first_difference(plain, testing::texture({30, 20}, 3)), "");
}

cv::Mat1f matched(const cv::Mat& left, const cv::Mat& right) {
  MatcherConfig config;
  config.max_disparity_px = 32;
  Matcher matcher(config);
  cv::Mat1f disparity;
  matcher.match(left, right, disparity);
  return disparity;
}

TEST(GreyImagesProperty, AnOffsetOfSixteenBitsChangesNoDisparity) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const TexturedPair pair = testing::textured_pair({150, 40}, static_cast<int>(3 * seed), seed);
    const cv::Mat1f expected = matched(pair.left, pair.right);
    for (const double offset : {0.0, 1000.0, 65280.0}) {
      cv::Mat left;
      cv::Mat right;
      pair.left.convertTo(left, CV_16U, 1.0, offset);
      pair.right.convertTo(right, CV_16U, 1.0, offset);
      EXPECT_EQ(first_difference(matched(left, right), expected), "") << offset;
    }
  }
}

TEST(GreyImagesProperty, ColourCopiesGiveTheDisparitiesOfGrey) {
  const TexturedPair pair = testing::textured_pair({150, 40}, 7, 1);
  const cv::Mat1f expected = matched(pair.left, pair.right);
  for (const int code : {cv::COLOR_GRAY2BGR, cv::COLOR_GRAY2BGRA}) {
    cv::Mat left;
    cv::Mat right;
    cv::cvtColor(pair.left, left, code);
    cv::cvtColor(pair.right, right, code);
    EXPECT_EQ(first_difference(matched(left, right), expected), "");
  }
}

}  // namespace
}  // namespace skyhalo
