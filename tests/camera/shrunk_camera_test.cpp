#include "skyhalo/camera/shrunk_camera.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/example_lenses.hpp"

namespace skyhalo {
namespace {

TEST(ShrunkCameraTest, BlocksOfPixelsBecomeOneThatLooksAtTheirMiddle) {
  for (const testing::ExampleLens& example : testing::example_lenses()) {
    const RawCamera camera{{641, 480}, example.lens};
    const RawCamera half = downscaled(camera, 2);
    EXPECT_EQ(half.size_px, cv::Size(320, 240));
    for (const Eigen::Vector3d& ray :
         {Eigen::Vector3d(0.1, 0.2, 1.0), Eigen::Vector3d(-0.2, 0.0, 1.0)}) {
      const auto full_px = project(camera.lens, ray);
      const auto half_px = project(half.lens, ray);
      ASSERT_TRUE(full_px && half_px);
      // Pixel (0, 0) of the small image is the middle of pixels 0 and 1: 0.5.
      EXPECT_LT((*half_px - (full_px->array() * 0.5 - 0.25).matrix()).norm(), 1e-9);
    }
  }
}

TEST(ShrunkCameraTest, ARectangleKeepsEveryPixelThatItTouches) {
  EXPECT_EQ(downscaled(cv::Rect(3, 4, 2, 2), 2), cv::Rect(1, 2, 2, 1));
  EXPECT_EQ(downscaled(cv::Rect(-3, -4, 5, 6), 4), cv::Rect(-1, -1, 2, 2));
  EXPECT_EQ(downscaled(cv::Rect(7, 9, 11, 13), 1), cv::Rect(7, 9, 11, 13));
  EXPECT_TRUE(downscaled(cv::Rect(3, 3, 0, 5), 2).empty());
  const int most = std::numeric_limits<int>::max();
  EXPECT_EQ(downscaled(cv::Rect(most - 1, 0, most, 2), 2), cv::Rect(most / 2, 0, most / 2 + 1, 1));
}

}  // namespace
}  // namespace skyhalo
