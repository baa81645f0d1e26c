#include "skyhalo/stereo/sgm/texture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;

cv::Mat1b textured(const cv::Mat1b& image, int texture_min) {
  const sgm::Plane<std::uint8_t> plane = testing::grey_plane(image);
  sgm::Plane<std::uint8_t> result(image.cols, image.rows);
  for (int v = 0; v < image.rows; ++v) {
    sgm::mark_texture(plane, v, texture_min, result);
  }
  return testing::image_of(result);
}

TEST(TextureTest, ADotIsSeenFromNineByNinePixels) {
  for (const int level : {97, 103}) {
    cv::Mat1b image(30, 90, std::uint8_t{100});
    image(15, 40) = static_cast<std::uint8_t>(level);
    cv::Mat1b expected(30, 90, std::uint8_t{0});
    expected(cv::Rect(36, 11, 9, 9)) = 1;
    for_each_instruction_set([&] {
      EXPECT_EQ(first_difference(textured(image, 3), expected), "");
      EXPECT_EQ(cv::countNonZero(textured(image, 4)), 0);
    });
  }
}

TEST(TextureTest, NoLeastRangeMarksAll) {
  const cv::Mat1b plain(3, 70, std::uint8_t{50});
  for_each_instruction_set([&] {
    EXPECT_EQ(cv::countNonZero(textured(plain, 0)), 3 * 70);
    EXPECT_EQ(cv::countNonZero(textured(plain, 1)), 0);
  });
}

TEST(TextureTest, TheLargestRangeIsFromBlackToWhite) {
  const cv::Mat1b both = (cv::Mat1b(1, 2) << 0, 255);
  const cv::Mat1b nearly = (cv::Mat1b(1, 2) << 0, 254);
  for_each_instruction_set([&] {
    EXPECT_EQ(cv::countNonZero(textured(both, 255)), 2);
    EXPECT_EQ(cv::countNonZero(textured(nearly, 255)), 0);
  });
}

TEST(TextureReference, EqualsTheNaiveTexture) {
  std::mt19937 random(1);
  for (int round = 0; round < 60; ++round) {
    const cv::Size size = testing::random_size(20, random);
    const int brightest = round % 2 == 0 ? 255 : 9;
    const int least = std::uniform_int_distribution<int>(0, brightest)(random);
    cv::Mat1b image(size, std::uint8_t{5});
    for (int dots = size.area() / 60 + 1; dots > 0; --dots) {
      image(static_cast<int>(random() % static_cast<unsigned>(size.height)),
            static_cast<int>(random() % static_cast<unsigned>(size.width))) =
          static_cast<std::uint8_t>(random() % static_cast<unsigned>(brightest + 1));
    }
    cv::Mat1b expected(size);
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        expected(v, u) = reference::texture(image, u, v) >= least ? 1 : 0;
      }
    }
    for_each_instruction_set(
        [&] { EXPECT_EQ(first_difference(textured(image, least), expected), ""); });
  }
}

}  // namespace
}  // namespace skyhalo
