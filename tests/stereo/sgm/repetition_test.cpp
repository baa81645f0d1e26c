#include "skyhalo/stereo/sgm/repetition.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;

cv::Mat1b confident(const cv::Mat1b& repeated, const cv::Mat1b& textured, int repetition_px) {
  const sgm::Plane<std::uint8_t> repeated_plane = testing::grey_plane(repeated);
  const sgm::Plane<std::uint8_t> textured_plane = testing::grey_plane(textured);
  sgm::Plane<std::uint8_t> counts(repeated.cols, repeated.rows);
  for (int v = 0; v < repeated.rows; ++v) {
    sgm::count_repeated(repeated_plane, v, counts);
  }
  sgm::Plane<std::uint8_t> result(repeated.cols, repeated.rows);
  for (int v = 0; v < repeated.rows; ++v) {
    sgm::mark_confident(counts, textured_plane, v, repetition_px, result);
  }
  return testing::image_of(result);
}

TEST(RepetitionTest, CountsNineByNinePixels) {
  // A block of 5 x 4 repeated pixels: all twenty are in the window of those at most 4 px away.
  cv::Mat1b repeated(30, 80, std::uint8_t{0});
  repeated(cv::Rect(38, 12, 5, 4)) = 1;
  const cv::Mat1b textured(30, 80, std::uint8_t{1});
  cv::Mat1b expected(30, 80, std::uint8_t{1});
  expected(cv::Rect(38, 11, 5, 6)) = 0;
  for_each_instruction_set([&] {
    EXPECT_EQ(first_difference(confident(repeated, textured, 20), expected), "");
    EXPECT_EQ(cv::countNonZero(confident(repeated, textured, 21)), 30 * 80);
  });
}

TEST(RepetitionTest, TheBorderCountsForWhatLiesBeyond) {
  cv::Mat1b repeated(12, 40, std::uint8_t{0});
  repeated.col(0) = 1;
  const cv::Mat1b textured(12, 40, std::uint8_t{1});
  // At column 0 five of nine columns are the first one; at column 1, four.
  for_each_instruction_set([&] {
    const cv::Mat1b result = confident(repeated, textured, 45);
    EXPECT_EQ(cv::countNonZero(result.col(0)), 0);
    EXPECT_EQ(cv::countNonZero(result.col(1)), 12);
  });
}

TEST(RepetitionTest, NeedsTextureToo) {
  const cv::Mat1b repeated(10, 70, std::uint8_t{0});
  cv::Mat1b textured(10, 70, std::uint8_t{1});
  textured(cv::Rect(3, 2, 60, 5)) = 0;
  for_each_instruction_set(
      [&] { EXPECT_EQ(first_difference(confident(repeated, textured, 1), textured), ""); });
}

TEST(RepetitionTest, NoCheckAtAllButTheTexture) {
  const cv::Mat1b repeated(10, 70, std::uint8_t{1});
  const cv::Mat1b textured(10, 70, std::uint8_t{1});
  for_each_instruction_set([&] {
    EXPECT_EQ(cv::countNonZero(confident(repeated, textured, 82)), 10 * 70);
    EXPECT_EQ(cv::countNonZero(confident(repeated, textured, 81)), 0);
  });
}

TEST(RepetitionTest, TakesBackWhatIsNotConfident) {
  const int width = 70;
  for_each_instruction_set([&] {
    sgm::Plane<std::uint8_t> sure(width, 1);
    sgm::Plane<std::int16_t> disparity_64(width, 1);
    disparity_64.fill_margin(-1);
    for (int u = 0; u < width; ++u) {
      sure.row(0)[u] = u % 3 == 0 ? 0 : 1;
      disparity_64.row(0)[u] = static_cast<std::int16_t>(u % 5 == 0 ? -1 : 640 + u);
    }
    sgm::keep_confident(sure, 0, disparity_64);
    for (int u = 0; u < width; ++u) {
      EXPECT_EQ(disparity_64.row(0)[u], u % 3 == 0 || u % 5 == 0 ? -1 : 640 + u) << u;
    }
    EXPECT_EQ(disparity_64.row(0)[width], -1);
  });
}

}  // namespace
}  // namespace skyhalo
