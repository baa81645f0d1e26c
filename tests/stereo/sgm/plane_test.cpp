#include "skyhalo/stereo/sgm/plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using Grey = sgm::Plane<std::uint8_t>;

TEST(PlaneTest, ReplicatesItsOutermostPixels) {
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(64, 5)}) {
    cv::Mat1b image(size);
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        image(v, u) = static_cast<std::uint8_t>(10 * v + u);
      }
    }
    const Grey plane = testing::grey_plane(image);
    for (int v = -4; v < size.height + 4; ++v) {
      for (int u = -4; u < size.width + 4; ++u) {
        ASSERT_EQ(plane.row(v)[u],
                  image(std::clamp(v, 0, size.height - 1), std::clamp(u, 0, size.width - 1)));
      }
    }
  }
}

TEST(PlaneTest, FillsAllAroundItsPixels) {
  Grey plane = testing::plane_of(cv::Mat1b(3, 70, std::uint8_t{5}));
  plane.fill_margin(9);
  for (int v = -4; v < 7; ++v) {
    for (int u = -4; u < 74; ++u) {
      const bool inside = v >= 0 && v < 3 && u >= 0 && u < 70;
      ASSERT_EQ(plane.row(v)[u], inside ? 5 : 9) << u << ", " << v;
    }
  }
}

TEST(PlaneTest, HasRoomForVectorsFromAnyPixel) {
  Grey plane(10, 2);
  std::fill_n(plane.row(1) + 9, 256, std::uint8_t{7});  // the sanitiser sees the end
  EXPECT_EQ(plane.row(1)[9], 7);
  EXPECT_EQ(plane.row(0)[9], 0);
}

TEST(PlaneTest, FillsTheMarginBesideOneRow) {
  Grey plane(10, 3);
  plane.fill_right_margin(1, 7);
  for (int u = 10; u < 14; ++u) {
    EXPECT_EQ(plane.row(0)[u], 0);
    EXPECT_EQ(plane.row(1)[u], 7);
    EXPECT_EQ(plane.row(2)[u], 0);
  }
  EXPECT_EQ(plane.row(1)[9], 0);
}

}  // namespace
}  // namespace skyhalo
