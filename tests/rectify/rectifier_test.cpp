#include "skyhalo/rectify/rectifier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

cv::Mat plain(int type, const cv::Size& size, const cv::Scalar& value) {
  return {size, type, value};
}

/// Brings images of this size, which come rectified, to the size that is matched.
Rectifier rectifier_of(const cv::Size& size, int factor) {
  StereoPair pair;
  pair.image_size_px = size;
  return Rectifier(pair, factor);
}

StereoImages both(const cv::Mat& image) {
  return {image, image};
}

std::string refusal(const StereoImages& images, int factor = 1) {
  const cv::Size size = images.left.empty() ? cv::Size(8, 6) : images.left.size();
  return message_of([&] { (void)rectifier_of(size, factor).rectify(images); });
}

TEST(RectifierTest, FactorOneKeepsGreyImages) {
  const auto [left, right] = testing::textured_pair({31, 17}, 3, 1);
  Rectifier rectifier = rectifier_of({31, 17}, 1);
  const RectifiedPair& pair = rectifier.rectify({left, right});
  EXPECT_EQ(cv::norm(pair.left, left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(pair.right, right, cv::NORM_INF), 0.0);
}

TEST(RectifierTest, HalvesByTheMeansOfTheBlocks) {
  const cv::Mat1b left = (cv::Mat1b(2, 4) << 10,
                          20,
                          0,
                          4,  //
                          30,
                          40,
                          8,
                          12);
  const cv::Mat1b right = (cv::Mat1b(2, 4) << 1,
                           1,
                           255,
                           255,  //
                           3,
                           3,
                           255,
                           255);
  Rectifier rectifier = rectifier_of({4, 2}, 2);
  const RectifiedPair& pair = rectifier.rectify({left, right});
  ASSERT_EQ(pair.left.size(), cv::Size(2, 1));
  ASSERT_EQ(pair.right.size(), cv::Size(2, 1));
  EXPECT_EQ(pair.left(0, 0), 25);  // (10 + 20 + 30 + 40) / 4
  EXPECT_EQ(pair.left(0, 1), 6);   // (0 + 4 + 8 + 12) / 4
  EXPECT_EQ(pair.right(0, 0), 2);  // (1 + 1 + 3 + 3) / 4
  EXPECT_EQ(pair.right(0, 1), 255);
}

TEST(RectifierTest, ShrinksByThree) {
  const cv::Mat1b image = (cv::Mat1b(3, 3) << 1,
                           2,
                           3,  //
                           4,
                           5,
                           6,  //
                           7,
                           8,
                           9);
  Rectifier rectifier = rectifier_of({3, 3}, 3);
  const RectifiedPair& pair = rectifier.rectify(both(image));
  ASSERT_EQ(pair.left.size(), cv::Size(1, 1));
  EXPECT_EQ(pair.left(0, 0), 5);  // 45 / 9
}

TEST(RectifierTest, LeavesOutWhatIsNoWholeBlock) {
  // 5 x 3 pixels hold 2 x 1 blocks of 2; the last column and row must not show.
  const cv::Mat1b image = (cv::Mat1b(3, 5) << 10,
                           20,
                           50,
                           50,
                           255,  //
                           30,
                           40,
                           50,
                           50,
                           255,  //
                           255,
                           255,
                           255,
                           255,
                           255);
  Rectifier rectifier = rectifier_of({5, 3}, 2);
  const RectifiedPair& pair = rectifier.rectify(both(image));
  ASSERT_EQ(pair.left.size(), cv::Size(2, 1));
  EXPECT_EQ(pair.left(0, 0), 25);
  EXPECT_EQ(pair.left(0, 1), 50);
}

TEST(RectifierTest, CutsEveryOddSizeToWholeBlocks) {
  for (const cv::Size& size : {cv::Size(7, 5), cv::Size(8, 5), cv::Size(7, 4), cv::Size(9, 11)}) {
    Rectifier rectifier = rectifier_of(size, 4);
    const RectifiedPair& pair = rectifier.rectify(both(plain(CV_8UC1, size, 9)));
    EXPECT_EQ(pair.left.size(), cv::Size(size.width / 4, size.height / 4));
    EXPECT_EQ(pair.right.size(), pair.left.size());
  }
}

TEST(RectifierTest, TakesColourAsGrey) {
  // Grey = 0.299 R + 0.587 G + 0.114 B, in the order blue, green, red.
  Rectifier rectifier = rectifier_of({4, 3}, 1);
  const cv::Size size(4, 3);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC3, size, {100, 0, 0}))).left(1, 1), 11);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC3, size, {0, 100, 0}))).left(1, 1), 59);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC3, size, {0, 0, 100}))).left(1, 1), 30);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC3, size, {77, 77, 77}))).right(2, 3), 77);
}

TEST(RectifierTest, IgnoresTheAlphaChannel) {
  Rectifier rectifier = rectifier_of({4, 3}, 1);
  const cv::Size size(4, 3);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC4, size, {0, 0, 100, 0}))).left(1, 1), 30);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC4, size, {0, 0, 100, 255}))).left(1, 1), 30);
}

TEST(RectifierTest, BringsSixteenBitsToEight) {
  Rectifier rectifier = rectifier_of({4, 3}, 1);
  const cv::Size size(4, 3);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_16UC1, size, 25600))).left(0, 0), 100);  // / 256
  EXPECT_EQ(rectifier.rectify(both(plain(CV_16UC1, size, 0))).left(0, 0), 0);
  EXPECT_EQ(rectifier.rectify(both(plain(CV_16UC1, size, 65535))).left(0, 0), 255);
}

TEST(RectifierTest, BringsSixteenBitColourToGrey) {
  Rectifier rectifier = rectifier_of({6, 4}, 2);
  const RectifiedPair& pair =
      rectifier.rectify(both(plain(CV_16UC3, {6, 4}, {12800, 12800, 12800})));
  ASSERT_EQ(pair.left.size(), cv::Size(3, 2));
  EXPECT_EQ(pair.left(1, 2), 50);  // 12800 / 256
}

TEST(RectifierTest, TheTwoImagesMayDifferInKind) {
  Rectifier rectifier = rectifier_of({4, 3}, 1);
  const cv::Size size(4, 3);
  const RectifiedPair& pair =
      rectifier.rectify({plain(CV_16UC1, size, 25600), plain(CV_8UC3, size, {40, 40, 40})});
  EXPECT_EQ(pair.left(0, 0), 100);
  EXPECT_EQ(pair.right(0, 0), 40);
}

/// True when the image has this size and the value everywhere.
bool is_plain(const cv::Mat1b& image, const cv::Size& size, int value) {
  return image.size() == size && cv::countNonZero(image == value) == size.area();
}

TEST(RectifierTest, ServesFrameAfterFrame) {
  Rectifier rectifier = rectifier_of({8, 6}, 2);
  for (int frame = 0; frame < 5; ++frame) {
    const int value = 10 * frame;
    const int type = frame % 2 == 0 ? CV_8UC1 : CV_8UC3;
    const cv::Size size(8, 6);
    const RectifiedPair& pair = rectifier.rectify(
        {plain(type, size, cv::Scalar::all(value)), plain(type, size, cv::Scalar::all(value + 1))});
    EXPECT_TRUE(is_plain(pair.left, {4, 3}, value)) << frame;
    EXPECT_TRUE(is_plain(pair.right, {4, 3}, value + 1)) << frame;
  }
}

TEST(RectifierTest, DoesNotTouchItsInput) {
  const cv::Mat1b image = testing::texture({20, 10}, 4);
  const cv::Mat1b before = image.clone();
  Rectifier rectifier = rectifier_of({20, 10}, 1);
  const RectifiedPair& pair = rectifier.rectify(both(image));
  EXPECT_EQ(cv::norm(image, before, cv::NORM_INF), 0.0);
  EXPECT_NE(pair.left.data, image.data);
}

TEST(RectifierTest, RefusesAFactorBelowOne) {
  EXPECT_THAT(message_of([] { (void)rectifier_of({8, 6}, 0); }), HasSubstr("matching.downscale"));
  EXPECT_THAT(message_of([] { (void)rectifier_of({8, 6}, -2); }), HasSubstr("matching.downscale"));
}

TEST(RectifierTest, RefusesImagesOfTwoSizes) {
  const cv::Mat small = plain(CV_8UC1, {8, 6}, 1);
  const cv::Mat large = plain(CV_8UC1, {10, 6}, 1);
  const std::string message = refusal({small, large});
  EXPECT_THAT(message, HasSubstr("8x6"));
  EXPECT_THAT(message, HasSubstr("10x6"));
}

TEST(RectifierTest, RefusesEmptyImages) {
  const cv::Mat image = plain(CV_8UC1, {8, 6}, 1);
  EXPECT_THAT(refusal({cv::Mat(), image}), HasSubstr("image"));
  EXPECT_THAT(refusal({image, cv::Mat()}), HasSubstr("image"));
  EXPECT_THAT(refusal({cv::Mat(), cv::Mat()}), HasSubstr("image"));
}

TEST(RectifierTest, RefusesOtherDepthsAndChannels) {
  const cv::Size size(8, 6);
  for (const int type : {CV_8SC1, CV_16SC1, CV_32SC1, CV_32FC1, CV_64FC3, CV_8UC2, CV_16UC2}) {
    EXPECT_THAT(refusal(both(plain(type, size, 1))), HasSubstr("8 or 16 bit")) << type;
  }
}

TEST(RectifierTest, RefusesImagesSmallerThanABlock) {
  EXPECT_THAT(refusal(both(plain(CV_8UC1, {3, 8}, 1)), 4), HasSubstr("smaller"));
  EXPECT_THAT(refusal(both(plain(CV_8UC1, {8, 3}, 1)), 4), HasSubstr("smaller"));
}

TEST(RectifierTest, WorksOnAfterAnError) {
  Rectifier rectifier = rectifier_of({4, 4}, 1);
  (void)message_of([&] { (void)rectifier.rectify(both(plain(CV_32FC1, {4, 4}, 1))); });
  EXPECT_EQ(rectifier.rectify(both(plain(CV_8UC1, {4, 4}, 7))).left(0, 0), 7);
}

TEST(RectifierProperty, EveryPixelIsTheMeanOfItsBlock) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const int factor = 1 + static_cast<int>(seed % 4);
    const cv::Mat1b image = testing::texture({53, 41}, seed);
    Rectifier rectifier = rectifier_of({53, 41}, factor);
    const RectifiedPair& pair = rectifier.rectify(both(image));
    for (int v = 0; v < pair.left.rows; ++v) {
      for (int u = 0; u < pair.left.cols; ++u) {
        const cv::Rect block(u * factor, v * factor, factor, factor);
        // Rounded, whichever way a half goes.
        EXPECT_NEAR(pair.left(v, u), cv::mean(image(block))[0], 0.5 + 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo
