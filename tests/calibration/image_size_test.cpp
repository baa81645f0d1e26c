#include "skyhalo/calibration/image_size.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

Error at_width(std::string_view message) {
  return input_error("a.yaml", "width: " + std::string(message));
}

constexpr const char* kRefusal = "a.yaml: width: expected a whole number of pixels in 1...16384";

TEST(ImageSizeTest, ASideIsAWholeNumberWithinTheLimits) {
  EXPECT_EQ(image_side_px(1.0, at_width), 1);
  EXPECT_EQ(image_side_px(752.0, at_width), 752);
  EXPECT_EQ(image_side_px(16384.0, at_width), 16384);
  for (const double bad : {0.0,
                           -1.0,
                           0.5,
                           752.5,
                           16385.0,
                           1e300,
                           std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    SCOPED_TRACE(bad);
    EXPECT_EQ(message_of([&] { (void)image_side_px(bad, at_width); }), kRefusal);
  }
}

TEST(ImageSizeTest, BothSidesOfASizeAreChecked) {
  EXPECT_EQ(checked_image_size_px({16384, 1}, at_width), cv::Size(16384, 1));
  for (const cv::Size& bad : {cv::Size(16385, 1), cv::Size(1, 16385), cv::Size(0, 1)}) {
    EXPECT_EQ(message_of([&] { (void)checked_image_size_px(bad, at_width); }), kRefusal);
  }
}

}  // namespace
}  // namespace skyhalo
