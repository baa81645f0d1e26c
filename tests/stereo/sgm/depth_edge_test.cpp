#include "skyhalo/stereo/sgm/depth_edge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;

cv::Mat1f dropped(const cv::Mat1s& image_64, int step_64) {
  const sgm::Plane<std::int16_t> plane = testing::disparity_plane(image_64);
  sgm::Plane<float> result(image_64.cols, image_64.rows);
  for (int v = 0; v < image_64.rows; ++v) {
    sgm::drop_depth_edges(plane, v, step_64, result.row(v));
  }
  return testing::image_of(result);
}

TEST(DepthEdgeTest, BothSidesOfAStepAreDropped) {
  cv::Mat1s image_64(6, 90, std::int16_t{64});
  image_64(cv::Rect(30, 3, 10, 3)) = 64 + 193;
  for_each_instruction_set([&] {
    const cv::Mat1f px = dropped(image_64, 192);
    for (const cv::Point& lost : {cv::Point(29, 4),
                                  cv::Point(30, 4),
                                  cv::Point(35, 2),
                                  cv::Point(35, 3),
                                  cv::Point(39, 5),
                                  cv::Point(40, 5)}) {
      EXPECT_TRUE(std::isnan(px(lost))) << lost;
    }
    EXPECT_EQ(px(4, 28), 1.0F);
    EXPECT_EQ(px(4, 31), (64.0F + 193.0F) / 64.0F);
    EXPECT_EQ(px(1, 35), 1.0F);
    EXPECT_EQ(px(2, 29), 1.0F);  // the step is beside its diagonal neighbour
    const cv::Mat1f kept = dropped(image_64, 193);
    EXPECT_EQ(cv::countNonZero(kept.colRange(0, 89) == kept.colRange(0, 89)), 6 * 89);
  });
}

TEST(DepthEdgeTest, AHoleIsNoStep) {
  cv::Mat1s image_64(3, 400, std::int16_t{16000});
  image_64(1, 50) = -1;
  for_each_instruction_set([&] {
    const cv::Mat1f px = dropped(image_64, 1);
    EXPECT_EQ(px(1, 49), 250.0F);
    EXPECT_TRUE(std::isnan(px(1, 50)));
    EXPECT_EQ(px(1, 51), 250.0F);
    EXPECT_EQ(px(0, 50), 250.0F);
  });
}

TEST(DepthEdgeTest, NoStepDropsNone) {
  cv::Mat1s row_64(1, 100, std::int16_t{0});
  row_64(0, 40) = 640;
  for_each_instruction_set([&] { EXPECT_EQ(dropped(row_64, 0)(0, 40), 10.0F); });
}

TEST(DepthEdgeTest, MatchesStayInTheOtherImage) {
  cv::Mat1s image_64(1, 10, std::int16_t{129});  // just more than 2 px
  cv::Mat1s whole_64(1, 10, std::int16_t{128});
  for_each_instruction_set([&] {
    const cv::Mat1f px = dropped(image_64, 0);
    EXPECT_FALSE(std::isnan(px(0, 6)));
    EXPECT_TRUE(std::isnan(px(0, 7)));
    EXPECT_EQ(dropped(whole_64, 0)(0, 7), 2.0F);
    EXPECT_TRUE(std::isnan(dropped(whole_64, 0)(0, 8)));
  });
}

TEST(DepthEdgeReference, EqualsTheNaiveSteps) {
  std::mt19937 random(1);
  for (int round = 0; round < 150; ++round) {
    cv::Mat1s image_64 = testing::random_disparity_64(testing::random_size(20, random), random);
    image_64 /= round % 9 + 1;
    reference::NaiveSgmSettings settings;
    settings.edge_step_64 = std::uniform_int_distribution<int>(0, 300)(random);
    const cv::Mat1f expected = reference::in_pixels(
        reference::within_other_image(reference::without_edges(image_64, settings)));
    for_each_instruction_set([&] {
      EXPECT_EQ(first_difference(dropped(image_64, settings.edge_step_64), expected), "");
    });
  }
}

}  // namespace
}  // namespace skyhalo
