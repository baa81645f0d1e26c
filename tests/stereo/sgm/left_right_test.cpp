#include "skyhalo/stereo/sgm/left_right.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace skyhalo {
namespace {

/// A row of eight pixels that all match 2 px on, confirmed and confident.
struct Row {
  std::vector<std::uint8_t> disparity = std::vector<std::uint8_t>(8, 2);
  std::vector<std::uint8_t> offset = {0, 0, 0, 0, 0, 0, 0x80, 0x80};
  std::vector<std::uint8_t> left_disparity = std::vector<std::uint8_t>(8, 2);
  std::vector<std::uint8_t> confident = std::vector<std::uint8_t>(8, 1);

  [[nodiscard]] std::vector<int> checked(int tolerance_64) const {
    std::vector<std::int16_t> found(8, 99);
    sgm::check_left_right(
        {disparity.data(), offset.data(), left_disparity.data(), confident.data()},
        8,
        tolerance_64,
        found.data());
    return {found.begin(), found.end()};
  }
};

TEST(LeftRightTest, ConfirmedWinnersStay) {
  EXPECT_EQ(Row().checked(64), (std::vector<int>{128, 128, 128, 128, 128, 128, -1, -1}));
}

TEST(LeftRightTest, OffsetsAreSigned) {
  Row row;
  row.offset[0] = 32;
  row.offset[1] = static_cast<std::uint8_t>(-32);
  row.offset[2] = static_cast<std::uint8_t>(-1);
  EXPECT_EQ(row.checked(64), (std::vector<int>{160, 96, 127, 128, 128, 128, -1, -1}));
}

TEST(LeftRightTest, TheLeftWinnerIsThatOfTheMatch) {
  Row row;
  row.left_disparity = {9, 9, 2, 9, 2, 2, 2, 2};  // the match of pixel 1 is pixel 3
  EXPECT_EQ(row.checked(64), (std::vector<int>{128, -1, 128, 128, 128, 128, -1, -1}));
}

TEST(LeftRightTest, TheToleranceItselfStays) {
  Row row;
  row.left_disparity = {0, 0, 3, 1, 4, 0, 3, 2};  // seen from pixels 0 to 5
  row.offset = {0, 0, 0, 0, static_cast<std::uint8_t>(-1), 1, 0x80, 0x80};
  EXPECT_EQ(row.checked(64), (std::vector<int>{128, 128, -1, -1, -1, 129, -1, -1}));
  EXPECT_EQ(row.checked(63), (std::vector<int>{-1, -1, -1, -1, -1, 129, -1, -1}));
  EXPECT_EQ(row.checked(0), (std::vector<int>{-1, -1, -1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(row.checked(128), (std::vector<int>{128, 128, 128, 128, 127, 129, -1, -1}));
}

TEST(LeftRightTest, NothingStaysWithoutTexture) {
  Row row;
  row.confident[3] = 0;
  EXPECT_EQ(row.checked(64), (std::vector<int>{128, 128, 128, -1, 128, 128, -1, -1}));
}

TEST(LeftRightTest, TheLargestDisparityFits) {
  std::vector<std::uint8_t> disparity(300, 255);
  std::vector<std::uint8_t> offset(300, 0);
  const std::vector<std::uint8_t> confident(300, 1);
  std::vector<std::int16_t> found(300);
  sgm::check_left_right(
      {disparity.data(), offset.data(), disparity.data(), confident.data()}, 300, 0, found.data());
  EXPECT_EQ(found[0], 255 * 64);
}

}  // namespace
}  // namespace skyhalo
