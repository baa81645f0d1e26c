#include "skyhalo/stereo/sgm/speckle.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::disparity_plane;
using testing::first_difference;
using testing::for_each_instruction_set;
using testing::image_of;

void drop(sgm::SpeckleFilter& filter, sgm::Plane<std::int16_t>& plane, int step_64, int size_px) {
  for (int v = plane.height() - 1; v >= 0; --v) {  // in any order
    filter.look_at(plane, v, step_64);
  }
  filter.drop_small(plane, size_px);
}

cv::Mat1s dropped(const cv::Mat1s& image_64, int step_64, int size_px) {
  sgm::SpeckleFilter filter(image_64.cols, image_64.rows);
  sgm::Plane<std::int16_t> plane = disparity_plane(image_64);
  drop(filter, plane, step_64, size_px);
  return image_of(plane);
}

TEST(SpeckleTest, IslandsOfTheSizeStayAndSmallerOnesGo) {
  const cv::Mat1s image_64 = (cv::Mat1s(3, 6) << 9,
                              9,
                              -1,
                              500,
                              500,
                              500,  //
                              9,
                              -1,
                              -1,
                              500,
                              -1,
                              -1,  //
                              -1,
                              9,
                              9,
                              -1,
                              70,
                              70);
  const cv::Mat1s without_two = (cv::Mat1s(3, 6) << 9,
                                 9,
                                 -1,
                                 500,
                                 500,
                                 500,  //
                                 9,
                                 -1,
                                 -1,
                                 500,
                                 -1,
                                 -1,  //
                                 -1,
                                 -1,
                                 -1,
                                 -1,
                                 -1,
                                 -1);
  const cv::Mat1s without_three = (cv::Mat1s(3, 6) << -1,
                                   -1,
                                   -1,
                                   500,
                                   500,
                                   500,  //
                                   -1,
                                   -1,
                                   -1,
                                   500,
                                   -1,
                                   -1,  //
                                   -1,
                                   -1,
                                   -1,
                                   -1,
                                   -1,
                                   -1);
  for_each_instruction_set([&] {
    EXPECT_EQ(first_difference(dropped(image_64, 0, 2), image_64), "");
    EXPECT_EQ(first_difference(dropped(image_64, 0, 3), without_two), "");
    EXPECT_EQ(first_difference(dropped(image_64, 0, 4), without_three), "");
    EXPECT_EQ(cv::countNonZero(dropped(image_64, 0, 5) != -1), 0);
  });
}

TEST(SpeckleTest, ASlopeIsOneIslandAndAStepParts) {
  const cv::Mat1s slope_64 = (cv::Mat1s(1, 5) << 0, 48, 96, 144, 192);
  const cv::Mat1s step_64 = (cv::Mat1s(1, 5) << 0, 48, 97, 144, 192);
  EXPECT_EQ(first_difference(dropped(slope_64, 48, 5), slope_64), "");
  EXPECT_EQ(cv::countNonZero(dropped(step_64, 48, 5) != -1), 0);
  EXPECT_EQ(cv::countNonZero(dropped(step_64, 48, 3) != -1), 3);
}

TEST(SpeckleTest, ArmsThatMeetFurtherDownAreOneIsland) {
  cv::Mat1s comb(5, 130, std::int16_t{-1});
  for (int u = 0; u < 130; u += 2) {
    comb.col(u) = 64;
  }
  comb.row(4) = 64;
  const int size_px = cv::countNonZero(comb != -1);
  for_each_instruction_set([&] {
    EXPECT_EQ(first_difference(dropped(comb, 0, size_px), comb), "");
    EXPECT_EQ(cv::countNonZero(dropped(comb, 0, size_px + 1) != -1), 0);
  });
}

TEST(SpeckleTest, DiagonalNeighboursAreTwoIslands) {
  const cv::Mat1s image_64 = (cv::Mat1s(2, 2) << 5, -1, -1, 5);
  EXPECT_EQ(cv::countNonZero(dropped(image_64, 0, 2) != -1), 0);
}

TEST(SpeckleTest, TheWorstChessboardHasRoom) {
  cv::Mat1s board(70, 131);
  for (int v = 0; v < board.rows; ++v) {
    for (int u = 0; u < board.cols; ++u) {
      board(v, u) = static_cast<std::int16_t>((u + v) % 2 == 0 ? 0 : 640);
    }
  }
  EXPECT_EQ(first_difference(dropped(board, 63, 1), board), "");
  EXPECT_EQ(cv::countNonZero(dropped(board, 63, 2) != -1), 0);
}

TEST(SpeckleReference, EqualsTheNaiveFilter) {
  std::mt19937 random(1);
  for (int round = 0; round < 150; ++round) {
    const cv::Mat1s image_64 =
        testing::random_disparity_64(testing::random_size(40, random), random);
    reference::NaiveSgmSettings settings;
    settings.speckle_size_px = std::uniform_int_distribution<int>(0, 60)(random);
    settings.speckle_step_64 = std::uniform_int_distribution<int>(0, 120)(random);
    const cv::Mat1s expected = reference::without_speckles(image_64, settings);
    for_each_instruction_set([&] {
      const cv::Mat1s found = dropped(image_64, settings.speckle_step_64, settings.speckle_size_px);
      EXPECT_EQ(first_difference(found, expected), "");
    });
  }
}

TEST(SpeckleReference, AnImageLeavesNoTraceInTheNext) {
  std::mt19937 random(2);
  sgm::SpeckleFilter filter(100, 30);
  for (int frame = 0; frame < 10; ++frame) {
    const cv::Mat1s image_64 = testing::random_disparity_64({100, 30}, random);
    reference::NaiveSgmSettings settings;
    settings.speckle_size_px = 20;
    sgm::Plane<std::int16_t> plane = disparity_plane(image_64);
    drop(filter, plane, settings.speckle_step_64, settings.speckle_size_px);
    const cv::Mat1s expected = reference::without_speckles(image_64, settings);
    EXPECT_EQ(first_difference(image_of(plane), expected), "");
  }
}

}  // namespace
}  // namespace skyhalo
