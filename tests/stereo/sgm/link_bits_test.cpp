#include "skyhalo/stereo/sgm/link_bits.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::disparity_plane;
using testing::for_each_instruction_set;

/// The bits of a row as text, pixel 0 first, whole words.
struct Links {
  std::string valid;
  std::string across;
  std::string down;
};

std::string as_text(const std::uint64_t* words, int width) {
  std::string text;
  for (int u = 0; u < (width + 63) / 64 * 64; ++u) {
    text += (words[u / 64] >> static_cast<unsigned>(u % 64) & 1U) != 0 ? '1' : '0';
  }
  return text;
}

Links links_of(const cv::Mat1s& image_64, int v, int step_64) {
  const std::size_t words = (static_cast<std::size_t>(image_64.cols) + 63) / 64 + 2;
  std::vector<std::uint64_t> valid(words, 0x5555555555555555U);
  std::vector<std::uint64_t> across(words, 0x5555555555555555U);
  std::vector<std::uint64_t> down(words, 0x5555555555555555U);
  sgm::find_links(
      disparity_plane(image_64), v, step_64, {valid.data(), across.data(), down.data()});
  return {as_text(valid.data(), image_64.cols),
          as_text(across.data(), image_64.cols),
          as_text(down.data(), image_64.cols)};
}

std::string word_of(const std::string& begin) {
  return begin + std::string(64 - begin.size(), '0');
}

TEST(LinkBitsTest, StepsAndHolesPart) {
  const cv::Mat1s image_64 = (cv::Mat1s(2, 7) << 0,
                              10,
                              90,
                              -1,
                              70,
                              7,
                              16000,  //
                              0,
                              10,
                              21,
                              21,
                              -1,
                              -1,
                              15990);
  for_each_instruction_set([&] {
    const Links upper = links_of(image_64, 0, 10);
    EXPECT_EQ(upper.valid, word_of("1110111"));
    EXPECT_EQ(upper.across, word_of("0100000"));
    EXPECT_EQ(upper.down, word_of(""));
    const Links lower = links_of(image_64, 1, 10);
    EXPECT_EQ(lower.valid, word_of("1111001"));
    EXPECT_EQ(lower.across, word_of("0101000"));
    EXPECT_EQ(lower.down, word_of("1100001"));
  });
}

TEST(LinkBitsTest, AHoleIsNoneOfTheSmallestDisparities) {
  const cv::Mat1s image_64 = (cv::Mat1s(1, 4) << 0, -1, 0, 0);
  for_each_instruction_set([&] {
    const Links row = links_of(image_64, 0, 16384);
    EXPECT_EQ(row.valid, word_of("1011"));
    EXPECT_EQ(row.across, word_of("0001"));
  });
}

char linked(const cv::Mat1s& image_64, cv::Point a, cv::Point b, int step_64) {
  const bool both =
      reference::has_disparity(image_64, a.x, a.y) && reference::has_disparity(image_64, b.x, b.y);
  return both && std::abs(image_64(a) - image_64(b)) <= step_64 ? '1' : '0';
}

TEST(LinkBitsReference, EqualsTheDefinition) {
  std::mt19937 random(1);
  for (int round = 0; round < 60; ++round) {
    const cv::Mat1s image_64 =
        testing::random_disparity_64(testing::random_size(6, random), random);
    const int step_64 = std::uniform_int_distribution<int>(0, 100)(random);
    for (int v = 0; v < image_64.rows; ++v) {
      Links expected;
      for (int u = 0; u < (image_64.cols + 63) / 64 * 64; ++u) {
        const cv::Point here(u, v);
        expected.valid += reference::has_disparity(image_64, u, v) ? '1' : '0';
        expected.across += linked(image_64, here, here - cv::Point(1, 0), step_64);
        expected.down += linked(image_64, here, here - cv::Point(0, 1), step_64);
      }
      for_each_instruction_set([&] {
        const Links found = links_of(image_64, v, step_64);
        EXPECT_EQ(found.valid, expected.valid);
        EXPECT_EQ(found.across, expected.across);
        EXPECT_EQ(found.down, expected.down);
      });
    }
  }
}

}  // namespace
}  // namespace skyhalo
