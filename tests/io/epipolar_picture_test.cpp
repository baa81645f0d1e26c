#include "skyhalo/io/epipolar_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace skyhalo {
namespace {

/// Where a picture is not grey.
cv::Mat1b coloured(const cv::Mat3b& picture) {
  cv::Mat1b mask(picture.size());
  std::transform(picture.begin(), picture.end(), mask.begin(), [](const cv::Vec3b& pixel) {
    return pixel[0] == pixel[1] && pixel[1] == pixel[2] ? 0 : 255;
  });
  return mask;
}

cv::Rect area_of(const cv::Mat1b& mask) {
  cv::Mat points;
  cv::findNonZero(mask, points);
  return points.empty() ? cv::Rect() : cv::boundingRect(points);
}

TEST(EpipolarPictureTest, TheImagesStandSideBySide) {
  const cv::Mat3b picture = epipolar_picture(cv::Mat1b(20, 30, 100), cv::Mat1b(20, 30, 50), 0);
  ASSERT_EQ(picture.size(), cv::Size(60, 20));
  EXPECT_EQ(picture(0, 29), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(picture(19, 30), cv::Vec3b(50, 50, 50));
  EXPECT_EQ(cv::countNonZero(coloured(picture)), 0);
}

TEST(EpipolarPictureTest, LinesCrossBothImagesAtEqualRows) {
  const cv::Mat3b picture = epipolar_picture(cv::Mat1b(100, 300, 90), cv::Mat1b(100, 300, 90), 25);
  for (int row = 1; row < 100; ++row) {
    for (const int column : {299, 300, 599}) {  // away from the rows' numbers
      EXPECT_EQ(picture(row, column) != cv::Vec3b(90, 90, 90), row % 25 == 0) << row;
    }
  }
  EXPECT_NE(picture(25, 400), picture(50, 400));  // neighbours can be told apart
  EXPECT_NE(picture(50, 400), picture(75, 400));
}

TEST(EpipolarPictureTest, RowsAreNumbered) {
  const cv::Mat3b picture = epipolar_picture(cv::Mat1b(100, 300, 90), cv::Mat1b(100, 300, 90), 50);
  const cv::Mat1b left_part = coloured(picture)(cv::Rect(0, 30, 60, 19));
  EXPECT_GT(cv::countNonZero(left_part), 20);
  EXPECT_EQ(cv::countNonZero(coloured(picture)(cv::Rect(60, 30, 540, 19))), 0);
}

TEST(EpipolarPictureTest, LinesOfAWidePairAreThicker) {
  const auto thickness = [](int width) {
    const cv::Mat3b picture =
        epipolar_picture(cv::Mat1b(100, width, 90), cv::Mat1b(100, width, 90), 50);
    return cv::countNonZero(coloured(picture).col(picture.cols - 1));
  };
  EXPECT_EQ(thickness(752), 1);
  EXPECT_GT(thickness(2000), 1);
}

TEST(EpipolarPictureTest, AMatchIsJoinedFromImageToImage) {
  // Right pixel (50, 40) is left pixel (70, 44).
  const std::vector<PairMatch> matches{{{50.0, 40.0}, 20.0, 4.0}};
  const cv::Mat3b picture =
      epipolar_picture(cv::Mat1b(100, 200, 90), cv::Mat1b(100, 200, 90), 0, matches);
  const cv::Rect area = area_of(coloured(picture));
  // Both ends with their dots, of about 2 px.
  EXPECT_NEAR(area.x, 68, 1);
  EXPECT_NEAR(area.br().x, 200 + 53, 1);
  EXPECT_NEAR(area.y, 38, 1);
  EXPECT_NEAR(area.br().y, 47, 1);
  EXPECT_NE(picture(44, 70), cv::Vec3b(90, 90, 90));
  EXPECT_NE(picture(40, 250), cv::Vec3b(90, 90, 90));
  EXPECT_NE(picture(42, 160), cv::Vec3b(90, 90, 90));
}

TEST(EpipolarPictureTest, TheColourOfAMatchTellsHowFarItsRowsDiffer) {
  const auto colour = [](double dv_px) {
    const std::vector<PairMatch> matches{{{50.0, 40.0}, 0.0, dv_px}};
    return epipolar_picture(cv::Mat1b(80, 200, 90), cv::Mat1b(80, 200, 90), 0, matches)(40, 250);
  };
  EXPECT_EQ(colour(0.4), colour(-0.4));
  EXPECT_EQ(colour(0.6), colour(-0.9));
  EXPECT_EQ(colour(1.5), colour(-8.0));
  EXPECT_GT(colour(0.4)[0], colour(0.4)[2]);  // blue
  EXPECT_GT(colour(0.6)[1], colour(0.6)[0]);  // yellow
  EXPECT_GT(colour(0.6)[2], colour(0.6)[0]);
  EXPECT_GT(colour(1.5)[2], colour(1.5)[1]);  // red
}

TEST(EpipolarPictureTest, ManyMatchesDoNotHideTheImages) {
  std::vector<PairMatch> matches(900);
  for (int i = 0; i < 900; ++i) {
    matches[static_cast<std::size_t>(i)] = {{50.0 + i % 30, 20.0 + i / 5.0}, 5.0, 0.0};
  }
  const cv::Mat3b picture =
      epipolar_picture(cv::Mat1b(220, 300, 90), cv::Mat1b(220, 300, 90), 0, matches);
  // Between the dots of the left image and those of the right one there are the joining lines only.
  const cv::Mat1b between = coloured(picture)(cv::Rect(150, 0, 1, 220));
  EXPECT_GE(cv::countNonZero(between), 24);
  EXPECT_LE(cv::countNonZero(between), 72);  // smoothed, a line touches three rows
  EXPECT_GT(area_of(between).height, 150);   // from top to bottom
}

TEST(EpipolarPictureTest, MatchesOutsideAndImagesOfOnePixelDoNoHarm) {
  const std::vector<PairMatch> matches{{{-500.0, 4000.0}, 20.0, 4.0}, {{0.0, 0.0}, 0.0, 0.0}};
  EXPECT_EQ(epipolar_picture(cv::Mat1b(1, 1, 9), cv::Mat1b(1, 1, 9), 1, matches).size(),
            cv::Size(2, 1));
}

}  // namespace
}  // namespace skyhalo
