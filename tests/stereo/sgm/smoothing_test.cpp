#include "skyhalo/stereo/sgm/smoothing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;
using testing::grey_plane;
using testing::image_of;

using Grey = sgm::Plane<std::uint8_t>;
using Smooth = void (*)(const Grey&, int, int, Grey&);

cv::Mat1b smoothed(const cv::Mat1b& image, Smooth smooth) {
  Grey result(image.cols, image.rows);
  smooth(grey_plane(image), 0, image.rows, result);
  return image_of(result);
}

/// One pixel of that level in the middle of 5 x 5 black ones.
cv::Mat1b dot(int level) {
  cv::Mat1b image(5, 5, std::uint8_t{0});
  image(2, 2) = static_cast<std::uint8_t>(level);
  return image;
}

TEST(SmoothingTest, TheCrossWeighsTheFourNeighbours) {
  const cv::Mat1b expected = (cv::Mat1b(5, 5) << 0,
                              0,
                              0,
                              0,
                              0,  //
                              0,
                              0,
                              10,
                              0,
                              0,  //
                              0,
                              10,
                              40,
                              10,
                              0,  //
                              0,
                              0,
                              10,
                              0,
                              0,  //
                              0,
                              0,
                              0,
                              0,
                              0);
  for_each_instruction_set(
      [&] { EXPECT_EQ(first_difference(smoothed(dot(80), sgm::smooth_cross), expected), ""); });
}

TEST(SmoothingTest, EveryMeanOfTheCrossRoundsUp) {
  for_each_instruction_set([] {
    const cv::Mat1b cross = smoothed(dot(1), sgm::smooth_cross);
    EXPECT_EQ(cross(2, 2), 1);
    EXPECT_EQ(cross(2, 1), 1);  // avg(0, avg(avg(0, 0), avg(0, 1)))
    EXPECT_EQ(cross(1, 2), 1);
    EXPECT_EQ(cross(1, 1), 0);
  });
}

TEST(SmoothingTest, TheBoxWeighsNineNeighbours) {
  const cv::Mat1b expected = (cv::Mat1b(5, 5) << 0,
                              0,
                              0,
                              0,
                              0,  //
                              0,
                              1,
                              2,
                              1,
                              0,  //
                              0,
                              2,
                              4,
                              2,
                              0,  //
                              0,
                              1,
                              2,
                              1,
                              0,  //
                              0,
                              0,
                              0,
                              0,
                              0);
  for_each_instruction_set(
      [&] { EXPECT_EQ(first_difference(smoothed(dot(16), sgm::smooth_box), expected), ""); });
}

TEST(SmoothingTest, TheMedianIsTheFifthOfNineInAnyOrder) {
  std::array<int, 9> levels{10, 20, 30, 40, 50, 60, 70, 80, 90};
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    std::shuffle(levels.begin(), levels.end(), random);
    cv::Mat1b image(3, 3);
    std::copy(levels.begin(), levels.end(), image.begin());
    EXPECT_EQ(smoothed(image, sgm::median_3x3)(1, 1), 50);
  }
}

TEST(SmoothingTest, TheOutermostPixelsStandForThoseBeyond) {
  const cv::Mat1b pair = (cv::Mat1b(1, 2) << 0, 8);
  for_each_instruction_set([&] {
    EXPECT_EQ(smoothed(pair, sgm::smooth_cross)(0, 0), 1);  // avg(0, avg(0, avg(0, 8)))
    EXPECT_EQ(smoothed(pair, sgm::smooth_box)(0, 1), 6);    // avg(8, avg(0, 8)) in every row
    EXPECT_EQ(smoothed(pair, sgm::median_3x3)(0, 0), 0);    // six of nine
  });
}

TEST(SmoothingTest, ReplicatesTheMargins) {
  std::mt19937 random(2);
  for (const Smooth smooth : {sgm::smooth_cross, sgm::smooth_box, sgm::median_3x3}) {
    const cv::Mat1b image = testing::random_grey({70, 6}, 0, 255, random);
    Grey result(70, 6);
    smooth(grey_plane(image), 0, 6, result);
    const Grey& found = result;
    for (int v = -4; v < 10; ++v) {
      for (int u = -4; u < 74; ++u) {
        ASSERT_EQ(found.row(v)[u], found.row(std::clamp(v, 0, 5))[std::clamp(u, 0, 69)]);
      }
    }
  }
}

TEST(SmoothingTest, OnlyTheAskedRowsChange) {
  std::mt19937 random(3);
  const cv::Mat1b image = testing::random_grey({70, 9}, 0, 255, random);
  for (const Smooth smooth : {sgm::smooth_cross, sgm::smooth_box, sgm::median_3x3}) {
    const cv::Mat1b whole = smoothed(image, smooth);
    cv::Mat1b expected(9, 70, std::uint8_t{77});
    whole.rowRange(3, 6).copyTo(expected.rowRange(3, 6));
    Grey result(70, 9);
    result.fill_margin(77);
    for (int v = 0; v < 9; ++v) {
      std::fill_n(result.row(v), 70, std::uint8_t{77});
    }
    smooth(grey_plane(image), 3, 6, result);
    EXPECT_EQ(first_difference(image_of(result), expected), "");
  }
}

TEST(SmoothingReference, EqualsTheNaiveFilters) {
  std::mt19937 random(4);
  for (int round = 0; round < 60; ++round) {
    const cv::Size size = testing::random_size(20, random);
    const cv::Mat1b image = testing::random_grey(size, 0, round % 3 == 0 ? 1 : 255, random);
    for_each_instruction_set([&] {
      EXPECT_EQ(
          first_difference(smoothed(image, sgm::smooth_cross), reference::cross_smoothed(image)),
          "");
      EXPECT_EQ(first_difference(smoothed(image, sgm::smooth_box), reference::box_smoothed(image)),
                "");
      EXPECT_EQ(first_difference(smoothed(image, sgm::median_3x3), reference::median3(image)), "");
    });
  }
}

}  // namespace
}  // namespace skyhalo
