#include "skyhalo/stereo/sgm/census.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;
using testing::grey_plane;

/// The census of three images: near, middle and far bits in turn.
cv::Mat1i census_of(const cv::Mat1b& raw, const cv::Mat1b& cross, const cv::Mat1b& box) {
  const sgm::CensusImages images{grey_plane(raw), grey_plane(cross), grey_plane(box)};
  sgm::Plane<std::uint8_t> near(raw.cols, raw.rows);
  sgm::Plane<std::uint8_t> middle(raw.cols, raw.rows);
  sgm::Plane<std::uint8_t> far(raw.cols, raw.rows);
  cv::Mat1i census(raw.size());
  for (int v = 0; v < raw.rows; ++v) {
    sgm::census_row(images, v, {near.row(v), middle.row(v), far.row(v)});
    for (int u = 0; u < raw.cols; ++u) {
      census(v, u) = near.row(v)[u] + 256 * middle.row(v)[u] + 65536 * far.row(v)[u];
    }
  }
  return census;
}

const cv::Mat1b kPlain(20, 20, std::uint8_t{100});

/// Neighbours row by row, in steps of the radius.
const std::array<cv::Point, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

TEST(CensusTest, EachDarkerNeighbourSetsItsBit) {
  const cv::Point centre(10, 10);
  for_each_instruction_set([&] {
    for (std::size_t k = 0; k < 8; ++k) {
      cv::Mat1b near = kPlain.clone();
      cv::Mat1b middle = kPlain.clone();
      cv::Mat1b far = kPlain.clone();
      near(centre + kNeighbours[k]) = 99;
      middle(centre + 2 * kNeighbours[k]) = 99;
      far(centre + 4 * kNeighbours[k]) = 99;
      EXPECT_EQ(census_of(near, kPlain, kPlain)(centre), 1 << k);
      EXPECT_EQ(census_of(kPlain, middle, kPlain)(centre), 1 << (8 + k));
      EXPECT_EQ(census_of(kPlain, kPlain, far)(centre), 1 << (16 + k));
    }
  });
}

TEST(CensusTest, EqualAndBrighterNeighboursSetNone) {
  cv::Mat1b bright = kPlain.clone();
  bright(10, 11) = 255;
  for_each_instruction_set([&] {
    EXPECT_EQ(cv::countNonZero(census_of(kPlain, kPlain, kPlain)), 0);
    EXPECT_EQ(census_of(bright, bright, bright)(10, 10), 0);
    EXPECT_EQ(census_of(bright, bright, bright)(10, 11), 0xffffff);
  });
}

TEST(CensusTest, ComparesByValueAlsoAboveTheSignBit) {
  cv::Mat1b image(20, 20, std::uint8_t{127});
  image(10, 10) = 128;
  for_each_instruction_set([&] { EXPECT_EQ(census_of(image, image, image)(10, 10), 0xffffff); });
}

TEST(CensusReference, EqualsTheNaiveCensus) {
  std::mt19937 random(1);
  for (int round = 0; round < 60; ++round) {
    const cv::Size size = testing::random_size(20, random);
    const cv::Mat1b image = testing::random_grey(size, 0, round % 3 == 0 ? 2 : 255, random);
    const cv::Mat1b cross = reference::cross_smoothed(image);
    const cv::Mat1b box = reference::box_smoothed(image);
    const cv::Mat1i expected = reference::census(image);
    for_each_instruction_set(
        [&] { EXPECT_EQ(first_difference(census_of(image, cross, box), expected), ""); });
  }
}

}  // namespace
}  // namespace skyhalo
