#include "skyhalo/dataset/frame_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(FrameChecksTest, FilesAreNumberedInSixDigits) {
  EXPECT_EQ(frame_file_name(0, ".png"), "000000.png");
  EXPECT_EQ(frame_file_name(1234, ".bin"), "001234.bin");
  EXPECT_EQ(frame_file_name(1234567, ""), "1234567");
}

TEST(FrameChecksTest, ImagesMustBeGreyOrColour) {
  const ImageWish any{{8, 4}, false};
  const ImageWish eight{{8, 4}, true};
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    EXPECT_NO_THROW(check_image(cv::Mat(4, 8, type), any, 2, "left"));
  }
  for (const int type : {CV_8UC4, CV_8UC2, CV_32FC1}) {
    EXPECT_THAT(message_of([&] { check_image(cv::Mat(4, 8, type), any, 2, "left"); }),
                HasSubstr("frame 2: left: expected a grey or BGR image of 8 bits or 16"));
  }
  EXPECT_THAT(message_of([&] { check_image(cv::Mat(4, 8, CV_16UC1), eight, 2, "left"); }),
              ::testing::EndsWith("of 8 bits"));
  EXPECT_THAT(message_of([&] { check_image(cv::Mat(), any, 0, "left"); }),
              HasSubstr("left has 0x0 pixels, expected 8x4 pixels"));
}

TEST(FrameChecksTest, ScansMustBeFiniteWithAReflectanceForEachPoint) {
  EXPECT_NO_THROW(check_scan({}, 1));
  EXPECT_NO_THROW(check_scan({{{1.0F, 2.0F, 3.0F}}, {}}, 1));
  EXPECT_NO_THROW(check_scan({{{1.0F, 2.0F, 3.0F}}, {0.5F}}, 1));
  EXPECT_THAT(message_of([] {
                check_scan({{{1.0F, 2.0F, 3.0F}}, {0.5F, 0.5F}}, 1);
              }),
              HasSubstr("frame 1: scan: expected a reflectance for each of 1 points, found 2"));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of([&] {
                check_scan({{{1.0F, kNan, 3.0F}}, {}}, 1);
              }),
              HasSubstr("frame 1: scan: point 0 is not finite"));
}

TEST(FrameChecksTest, AnImageOfAnotherSizeIsNamed) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  write_png(file, cv::Mat(4, 8, CV_8UC1, cv::Scalar(7)));
  EXPECT_EQ(read_image_of_size(file, {8, 4}).cols, 8);
  EXPECT_THAT(message_of([&] {
                (void)read_image_of_size(file, {4, 8});
              }),
              HasSubstr("a.png: has 8x4 pixels, expected 4x8 pixels"));
}

}  // namespace
}  // namespace skyhalo
