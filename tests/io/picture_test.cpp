#include "skyhalo/io/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/colour.hpp"

namespace skyhalo {
namespace {

const cv::Vec3b kWhite(255, 255, 255);
const cv::Vec3b kBlack(0, 0, 0);

int brightness(const cv::Vec3b& colour) {
  return colour[0] + colour[1] + colour[2];
}

VoxelGrid small_grid() {
  return {.min_m = {-1.0, -1.0, 0.0}, .voxel_m = 1.0, .size = {3, 2, 3}};
}

LogOdds& cell(DenseMap& map, int x, int y, int z) {
  return map.at(map.grid().offset_of({x, y, z}));
}

/// A colour that says it is blue before anything else, and light.
void expect_pale_blue(const cv::Vec3b& colour) {
  EXPECT_GT(colour[0], colour[2]);
  EXPECT_GT(brightness(colour), 600);
  EXPECT_NE(colour, kWhite);
}

TEST(PictureTest, FromAboveXIsToTheRightAndYUp) {
  const cv::Mat3b picture = picture_from_above(small_grid(), 4, [](int x, int y) {
    return cv::Vec3b(static_cast<unsigned char>(10 * x), static_cast<unsigned char>(100 * y), 7);
  });
  // 3 x 2 cells of 4 pixels; y = 0 is the lower half.
  ASSERT_EQ(picture.size(), cv::Size(12, 8));
  EXPECT_EQ(picture(7, 0), cv::Vec3b(0, 0, 7));
  EXPECT_EQ(picture(4, 11), cv::Vec3b(20, 0, 7));
  EXPECT_EQ(picture(3, 4), cv::Vec3b(10, 100, 7));
  EXPECT_EQ(picture(0, 0), cv::Vec3b(0, 100, 7));
}

TEST(PictureTest, ADisparityIsBrightWhereItIsNear) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat1f disparity = (cv::Mat1f(2, 2) << 4.0F, 20.0F, kNan, 40.0F);
  const cv::Mat3b picture = disparity_picture(disparity);
  ASSERT_EQ(picture.size(), cv::Size(2, 2));
  EXPECT_EQ(picture(1, 0), kBlack);
  EXPECT_LT(brightness(picture(0, 0)), brightness(picture(0, 1)));
  EXPECT_LT(brightness(picture(0, 1)), brightness(picture(1, 1)));
  EXPECT_NE(picture(0, 0), kBlack);
}

TEST(PictureTest, AFewWrongDisparitiesDoNotDarkenTheRest) {
  // 0.5 % of the pixels are far too large; the rest is one disparity and must have the brightest
  // colour.
  cv::Mat1f disparity(20, 50, 10.0F);
  for (int i = 0; i < 5; ++i) {
    disparity(0, i) = 250.0F;
  }
  EXPECT_EQ(disparity_picture(disparity)(10, 10), scale_colour(1.0));
}

TEST(PictureTest, WithoutAnyDisparityThePictureIsBlack) {
  const cv::Mat1f disparity(4, 6, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(cv::countNonZero(disparity_picture(disparity).reshape(1)), 0);
}

TEST(PictureTest, AGridIsSeenFromTheBody) {
  SphericalGrid grid(make_grid_geometry({.theta_min_rad = rad_from_deg(80.0),
                                         .theta_max_rad = rad_from_deg(100.0),
                                         .phi_min_rad = rad_from_deg(-30.0),
                                         .phi_max_rad = rad_from_deg(30.0),
                                         .step_rad = rad_from_deg(10.0)}),
                     {.kind = DepthRuleKind::kMean});
  grid.add(3.0 * direction(rad_from_deg(85.0), rad_from_deg(25.0)));  // up and to the left, near
  grid.add(12.0 *
           direction(rad_from_deg(95.0), rad_from_deg(-25.0)));  // down and to the right, far
  const cv::Mat3b picture = grid_picture(grid, 5);
  ASSERT_EQ(picture.size(), cv::Size(30, 10));  // 6 columns, 2 rows
  const cv::Vec3b near_colour = picture(2, 2);
  const cv::Vec3b far_colour = picture(7, 27);
  const cv::Vec3b none = picture(2, 27);
  EXPECT_GT(brightness(near_colour), brightness(far_colour));
  EXPECT_NE(far_colour, none);
  EXPECT_EQ(picture(7, 2), none);
  EXPECT_EQ(none[0], none[1]);  // dark grey
  EXPECT_EQ(none[1], none[2]);
  EXPECT_GT(none[0], 0);
  EXPECT_LT(none[0], 100);
}

TEST(PictureTest, ASliceShowsOneLayer) {
  DenseMap map(small_grid());
  cell(map, 0, 0, 1) = 32000;   // occupied: 1 - p rounds to 0
  cell(map, 1, 0, 1) = -32000;  // free
  cell(map, 2, 0, 1) = 0;       // p = 0.5: 127.5 of 255
  cell(map, 0, 1, 0) = 32000;   // another layer
  const cv::Mat3b picture = slice_picture(map, 1.2, 2);
  ASSERT_EQ(picture.size(), cv::Size(6, 4));
  EXPECT_EQ(picture(3, 0), kBlack);
  EXPECT_EQ(picture(3, 2), kWhite);
  EXPECT_NEAR(picture(3, 4)[0], 127.5, 1.0);
  EXPECT_EQ(picture(3, 4)[0], picture(3, 4)[2]);
  expect_pale_blue(picture(0, 0));
}

TEST(PictureTest, FromAboveTheHighestOccupiedCellCounts) {
  DenseMap map(small_grid());
  cell(map, 0, 0, 0) = 3000;
  cell(map, 0, 0, 2) = 3000;
  cell(map, 1, 0, 2) = 3000;
  cell(map, 2, 0, 0) = 3000;
  cell(map, 2, 0, 1) = -3000;
  cell(map, 0, 1, 1) = -3000;
  cell(map, 1, 1, 1) = 500;  // p = 0.62, not above 0.7
  const cv::Mat3b picture = top_picture(map, 0.7, 1);
  ASSERT_EQ(picture.size(), cv::Size(3, 2));
  EXPECT_EQ(picture(1, 0), picture(1, 1));
  EXPECT_NE(picture(1, 0), picture(1, 2));
  EXPECT_LT(brightness(picture(1, 2)), brightness(picture(1, 1)));
  EXPECT_EQ(picture(0, 0), kWhite);
  EXPECT_EQ(picture(0, 1), kWhite);
  expect_pale_blue(picture(0, 2));
}

TEST(PictureTest, FromAboveAnUnknownCellIsNeverOccupied) {
  const DenseMap map(small_grid());
  expect_pale_blue(top_picture(map, 0.4, 1)(0, 0));
}

}  // namespace
}  // namespace skyhalo
