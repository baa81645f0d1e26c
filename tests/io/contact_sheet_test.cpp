#include "skyhalo/io/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace skyhalo {
namespace {

const cv::Vec3b kRed(0, 0, 255);
const cv::Vec3b kGreen(0, 255, 0);
const cv::Vec3b kBlue(255, 0, 0);

/// The smallest rectangle with all pixels of a colour.
cv::Rect area_of(const cv::Mat3b& sheet, const cv::Vec3b& colour) {
  cv::Mat1b same;
  cv::inRange(sheet, colour, colour, same);
  cv::Mat points;
  cv::findNonZero(same, points);
  return points.empty() ? cv::Rect() : cv::boundingRect(points);
}

TitledPicture flat(const char* title, const cv::Size& size, const cv::Vec3b& colour) {
  return {title, cv::Mat3b(size, colour)};
}

TEST(ContactSheetTest, PicturesAreScaledToTheWidth) {
  // 40 x 20 to the width of 100 is 100 x 50; 200 x 100 too; 100 x 30 stays.
  const cv::Mat3b sheet = contact_sheet(
      {flat("a", {40, 20}, kRed), flat("b", {200, 100}, kGreen), flat("c", {100, 30}, kBlue)},
      2,
      100);
  EXPECT_EQ(area_of(sheet, kRed).size(), cv::Size(100, 50));
  EXPECT_EQ(area_of(sheet, kGreen).size(), cv::Size(100, 50));
  EXPECT_EQ(area_of(sheet, kBlue).size(), cv::Size(100, 30));
}

TEST(ContactSheetTest, RowsAreFilledFromTheLeft) {
  const cv::Mat3b sheet = contact_sheet(
      {flat("a", {50, 50}, kRed), flat("b", {50, 20}, kGreen), flat("c", {50, 50}, kBlue)}, 2, 50);
  const cv::Rect red = area_of(sheet, kRed);
  const cv::Rect green = area_of(sheet, kGreen);
  const cv::Rect blue = area_of(sheet, kBlue);
  EXPECT_EQ(red.y, green.y);
  EXPECT_GE(green.x, red.x + red.width);
  EXPECT_EQ(blue.x, red.x);
  EXPECT_GE(blue.y, red.y + red.height);
}

TEST(ContactSheetTest, ATitleStandsAboveItsPicture) {
  const auto dark_pixels_above = [](const char* title) {
    const cv::Mat3b sheet = contact_sheet({flat(title, {120, 50}, kRed)}, 1, 120);
    const cv::Mat3b above = sheet.rowRange(0, area_of(sheet, kRed).y);
    cv::Mat1b dark;
    cv::inRange(above, cv::Scalar(0, 0, 0), cv::Scalar(128, 128, 128), dark);
    return cv::countNonZero(dark);
  };
  EXPECT_EQ(dark_pixels_above(""), 0);
  EXPECT_GT(dark_pixels_above("Disparity"), 50);
}

TEST(ContactSheetTest, FewerPicturesThanColumnsAreFine) {
  const cv::Mat3b sheet = contact_sheet({flat("a", {30, 30}, kRed)}, 4, 30);
  EXPECT_EQ(area_of(sheet, kRed).size(), cv::Size(30, 30));
}

}  // namespace
}  // namespace skyhalo
