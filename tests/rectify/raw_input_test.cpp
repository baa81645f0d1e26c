// What a rectifier of raw pairs takes and refuses, and that threads change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "rectify/raw_scene.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

/// EuRoC's camera of 752 x 480 px to the left of a fisheye of 848 x 800.
StereoPair mixed_pair(PairModelKind kind) {
  testing::RandomRays random(13);
  const RawPair raw = testing::turned_pair(
      testing::radial_tangential_examples()[1], testing::kannala_brandt_examples()[3], random);
  return testing::stereo_pair(raw, {.model = kind});
}

const cv::Size kLeftSize(752, 480);
const cv::Size kRightSize(848, 800);

StereoImages textures() {
  return {testing::texture(kLeftSize, 1), testing::texture(kRightSize, 2)};
}

std::string refusal(const StereoImages& images) {
  Rectifier rectifier(mixed_pair(PairModelKind::kPinhole), 2);
  return message_of([&] { (void)rectifier.rectify(images); });
}

TEST(RawRectifierTest, GivesImagesAndMasksOfTheMatchedSize) {
  for (const PairModelKind kind : {PairModelKind::kPinhole, PairModelKind::kSpherical}) {
    const StereoPair pair = mixed_pair(kind);
    for (const int factor : {1, 2, 3, 4}) {
      Rectifier rectifier(pair, factor);
      const RectifiedPair& images = rectifier.rectify(textures());
      const cv::Size expected(pair.image_size_px.width / factor,
                              pair.image_size_px.height / factor);
      for (const cv::Mat1b& image :
           {images.left, images.right, images.left_valid, images.right_valid}) {
        EXPECT_EQ(image.size(), expected) << "factor " << factor;
      }
    }
  }
}

TEST(RawRectifierTest, RectifiedPairsHaveNoMasks) {
  StereoPair pair = mixed_pair(PairModelKind::kPinhole);
  pair.raw.reset();
  const cv::Mat1b image = testing::texture(pair.image_size_px, 3);
  Rectifier rectifier(pair, 2);
  const RectifiedPair& images = rectifier.rectify({image, image});
  EXPECT_TRUE(images.left_valid.empty());
  EXPECT_TRUE(images.right_valid.empty());
}

TEST(RawRectifierTest, RefusesImagesThatAreNotOfTheRawSizes) {
  const auto [left, right] = textures();
  // Of the virtual size, swapped, and both of one size.
  const cv::Mat1b small = testing::texture({640, 400}, 4);
  EXPECT_THAT(refusal({small, right}), HasSubstr("752x480"));
  EXPECT_THAT(refusal({small, right}), HasSubstr("640x400"));
  EXPECT_THAT(refusal({left, small}), HasSubstr("848x800"));
  EXPECT_THAT(refusal({right, left}), HasSubstr("752x480"));
  EXPECT_THAT(refusal({left, left}), HasSubstr("right"));
  EXPECT_THAT(refusal({right, right}), HasSubstr("left"));
}

TEST(RawRectifierTest, RefusesEmptyImagesAndOtherKinds) {
  const auto [left, right] = textures();
  EXPECT_THAT(refusal({cv::Mat(), right}), HasSubstr("empty"));
  EXPECT_THAT(refusal({left, cv::Mat()}), HasSubstr("empty"));
  for (const int type : {CV_8SC1, CV_16SC1, CV_32FC1, CV_64FC3, CV_8UC2}) {
    EXPECT_THAT(refusal({left, cv::Mat(kRightSize, type, cv::Scalar::all(1.0))}),
                HasSubstr("8 or 16 bit"));
  }
}

TEST(RawRectifierTest, WorksOnAfterAnError) {
  Rectifier rectifier(mixed_pair(PairModelKind::kPinhole), 2);
  (void)message_of([&] { (void)rectifier.rectify({}); });
  EXPECT_GT(cv::countNonZero(rectifier.rectify(textures()).left), 0);
}

TEST(RawRectifierTest, ColourAndSixteenBitsComeOutAsGrey) {
  const auto [left, right] = textures();
  Rectifier rectifier(mixed_pair(PairModelKind::kSpherical), 2);
  const RectifiedPair& images = rectifier.rectify({left, right});
  const cv::Mat1b grey_left = images.left.clone();
  const cv::Mat1b grey_right = images.right.clone();
  StereoImages other;
  cv::cvtColor(left, other.left, cv::COLOR_GRAY2BGR);
  right.convertTo(other.right, CV_16U, 256.0);
  (void)rectifier.rectify(other);
  EXPECT_EQ(cv::norm(images.left, grey_left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(images.right, grey_right, cv::NORM_INF), 0.0);
}

TEST(RawRectifierTest, DoesNotTouchItsInput) {
  const auto [left, right] = textures();
  const cv::Mat left_before = left.clone();
  const cv::Mat right_before = right.clone();
  Rectifier rectifier(mixed_pair(PairModelKind::kPinhole), 1);
  (void)rectifier.rectify({left, right});
  EXPECT_EQ(cv::norm(left, left_before, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(right, right_before, cv::NORM_INF), 0.0);
}

TEST(RawRectifierTest, TakesPartsOfLargerImages) {
  const auto [left, right] = textures();
  cv::Mat frame(900, 1000, CV_8UC1, cv::Scalar(77));
  const cv::Mat part = frame(cv::Rect(cv::Point(31, 17), kLeftSize));
  left.copyTo(part);
  Rectifier whole(mixed_pair(PairModelKind::kPinhole), 2);
  Rectifier parts(mixed_pair(PairModelKind::kPinhole), 2);
  EXPECT_EQ(
      cv::norm(whole.rectify({left, right}).left, parts.rectify({part, right}).left, cv::NORM_INF),
      0.0);
}

/// All four images of a rectification with so many threads of OpenCV.
std::vector<cv::Mat1b> with_threads(const StereoPair& pair, int factor, int threads) {
  cv::setNumThreads(threads);
  Rectifier rectifier(pair, factor);
  const RectifiedPair& images = rectifier.rectify(textures());
  std::vector<cv::Mat1b> all{images.left.clone(),
                             images.right.clone(),
                             images.left_valid.clone(),
                             images.right_valid.clone()};
  cv::setNumThreads(-1);
  return all;
}

TEST(RawRectifierProperty, OneAndFourThreadsGiveTheSameBits) {
  for (const PairModelKind kind : {PairModelKind::kPinhole, PairModelKind::kSpherical}) {
    const StereoPair pair = mixed_pair(kind);
    for (const int factor : {1, 2, 4}) {
      const std::vector<cv::Mat1b> one = with_threads(pair, factor, 1);
      const std::vector<cv::Mat1b> four = with_threads(pair, factor, 4);
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(cv::norm(one[i], four[i], cv::NORM_INF), 0.0) << "factor " << factor;
      }
      EXPECT_GT(cv::countNonZero(one[0]), one[0].size().area() / 2);
    }
  }
}

}  // namespace
}  // namespace skyhalo
