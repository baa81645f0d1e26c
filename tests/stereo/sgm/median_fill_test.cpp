#include "skyhalo/stereo/sgm/median_fill.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::disparity_plane;
using testing::first_difference;
using testing::for_each_instruction_set;

cv::Mat1s filled(const cv::Mat1s& image_64, int fill_min) {
  const sgm::Plane<std::int16_t> plane = disparity_plane(image_64);
  sgm::RowMedians rows{{image_64.cols, image_64.rows}, {image_64.cols, image_64.rows}};
  sgm::Plane<std::int16_t> result(image_64.cols, image_64.rows);
  result.fill_margin(-1);
  for (int v = -2; v < image_64.rows + 2; ++v) {
    sgm::median_along_row(plane, v, rows);
  }
  for (int v = 0; v < image_64.rows; ++v) {
    sgm::median_down_column(plane, rows, v, fill_min, result);
  }
  return testing::image_of(result);
}

TEST(MedianFillTest, AHoleIsFilledByEnoughNeighbours) {
  cv::Mat1s image_64(9, 70, std::int16_t{640});
  image_64(4, 40) = -1;
  const cv::Mat1s whole(9, 70, std::int16_t{640});
  for_each_instruction_set([&] {
    const cv::Rect inner(2, 2, 66, 5);  // outside, the margins' holes have a say
    EXPECT_EQ(first_difference(cv::Mat1s(filled(image_64, 24)(inner)), cv::Mat1s(whole(inner))),
              "");
    EXPECT_EQ(filled(image_64, 25)(4, 40), -1);
    EXPECT_EQ(filled(image_64, 26)(4, 40), -1);
    EXPECT_EQ(filled(image_64, 26)(4, 41), 640);
  });
}

TEST(MedianFillTest, AnOutlierGoes) {
  cv::Mat1s image_64(9, 70, std::int16_t{640});
  image_64(4, 40) = 6400;
  for_each_instruction_set([&] { EXPECT_EQ(filled(image_64, 11)(4, 40), 640); });
}

TEST(MedianFillTest, TheMedianOfRowMedians) {
  // Row medians 30, 10, 50, 20, 40: their median is 30, that of all 25 is not.
  const cv::Mat1s image_64 = (cv::Mat1s(5, 5) << 30,
                              31,
                              30,
                              29,
                              30,  //
                              10,
                              10,
                              90,
                              10,
                              90,  //
                              50,
                              50,
                              50,
                              50,
                              50,  //
                              20,
                              90,
                              20,
                              90,
                              20,  //
                              40,
                              90,
                              40,
                              90,
                              40);
  for_each_instruction_set([&] { EXPECT_EQ(filled(image_64, 11)(2, 2), 30); });
}

TEST(MedianFillTest, HolesStandForLessAndForMoreInTurn) {
  // In even rows both holes stand for less than all, and the row's median is 100; in odd rows for
  // more, and it is 300.
  cv::Mat1s image_64(6, 5, std::int16_t{-1});
  image_64.col(1) = 100;
  image_64.col(2) = 200;
  image_64.col(3) = 300;
  for_each_instruction_set([&] {
    const cv::Mat1s median = filled(image_64, 11);
    EXPECT_EQ(median(2, 2), 100);  // of three even rows and two odd ones
    EXPECT_EQ(median(3, 2), 300);
  });
}

TEST(MedianFillTest, NothingComesOfNothing) {
  const cv::Mat1s holes(6, 70, std::int16_t{-1});
  for_each_instruction_set([&] { EXPECT_EQ(cv::countNonZero(filled(holes, 1) != -1), 0); });
}

TEST(MedianFillReference, EqualsTheNaiveMedian) {
  std::mt19937 random(1);
  for (int round = 0; round < 150; ++round) {
    const cv::Mat1s image_64 =
        testing::random_disparity_64(testing::random_size(25, random), random);
    reference::NaiveSgmSettings settings;
    settings.fill_min = std::uniform_int_distribution<int>(1, 26)(random);
    const cv::Mat1s expected = reference::median_filled(image_64, settings);
    for_each_instruction_set(
        [&] { EXPECT_EQ(first_difference(filled(image_64, settings.fill_min), expected), ""); });
  }
}

}  // namespace
}  // namespace skyhalo
