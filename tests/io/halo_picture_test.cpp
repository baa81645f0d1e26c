#include "skyhalo/io/halo_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/colour.hpp"

namespace skyhalo {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kCellPx = 20;
constexpr int kSizePx = 401;
constexpr double kMaxRangeM = 20.0;
const PitchBand kBand{-rad_from_deg(10.0), rad_from_deg(10.0)};

int brightness(const cv::Vec3b& colour) {
  return colour[0] + colour[1] + colour[2];
}

/// Cells of 10 degrees: 18 rows, 36 columns.
Halo empty_halo() {
  return Halo(rad_from_deg(10.0));
}

/// The cell whose middle lies in a direction (degrees; up and left are positive).
GridCell cell_at(const Halo& halo, double pitch_deg, double azimuth_deg) {
  const auto cell =
      halo.geometry().cell_of(rad_from_deg(90.0 - pitch_deg), rad_from_deg(azimuth_deg));
  return cell.value_or(GridCell{});
}

/// Where that cell's middle is in a picture with `kCellPx`: 36 cells wide, from 180 degrees left to
/// 180 degrees right; 18 high, from straight up to straight down.
cv::Point place_of(double pitch_deg, double azimuth_deg) {
  return {static_cast<int>(std::lround((180.0 - azimuth_deg) / 10.0 * kCellPx)),
          static_cast<int>(std::lround((90.0 - pitch_deg) / 10.0 * kCellPx))};
}

/// A place seen from above: the body is in the middle and 20 m are 48 % of the size.
cv::Point place_from_above(double range_m, double azimuth_deg) {
  const double px = 0.48 * kSizePx / kMaxRangeM * range_m;
  const double azimuth = rad_from_deg(azimuth_deg);
  return {static_cast<int>(std::lround(200.0 - px * std::sin(azimuth))),
          static_cast<int>(std::lround(200.0 - px * std::cos(azimuth)))};
}

cv::Mat3b top_picture_of(const Halo& halo,
                         const Eigen::Matrix3d& R_map_body = Eigen::Matrix3d::Identity()) {
  return halo_top_picture(halo, kBand, R_map_body, kMaxRangeM, kSizePx);
}

/// Says the same of all cells.
void set_all(Halo& halo, float depth_m, float free_to_m) {
  for (int row = 0; row < halo.geometry().rows; ++row) {
    for (int col = 0; col < halo.geometry().cols; ++col) {
      halo.set({row, col}, depth_m, free_to_m);
    }
  }
}

/// Says the same of the four rows about the horizon between two azimuths.
void set_sector(Halo& halo, double from_deg, double to_deg, float depth_m, float free_to_m) {
  for (double azimuth_deg = from_deg + 5.0; azimuth_deg < to_deg; azimuth_deg += 10.0) {
    for (const double pitch_deg : {-15.0, -5.0, 5.0, 15.0}) {
      halo.set(cell_at(halo, pitch_deg, azimuth_deg), depth_m, free_to_m);
    }
  }
}

/// Light without a hue: the ground or the lines of a light hatch.
void expect_light_grey(const cv::Vec3b& colour) {
  EXPECT_GT(brightness(colour), 400);
  EXPECT_LT(brightness(colour), brightness(HaloColours::kFree) - 60);
  EXPECT_EQ(colour[0], colour[2]);
}

/// Dark and without a hue: the ground or the lines of a dark hatch.
void expect_dark(const cv::Vec3b& colour) {
  EXPECT_LT(brightness(colour), 300);
  EXPECT_EQ(colour[0], colour[2]);
}

TEST(HaloPictureTest, TheScaleIsTheSameInAllPictures) {
  EXPECT_EQ(range_colour(1.0), scale_colour(1.0));
  EXPECT_EQ(range_colour(0.2), scale_colour(1.0));
  EXPECT_EQ(range_colour(0.0), scale_colour(1.0));
  EXPECT_EQ(range_colour(33.0), scale_colour(0.0));
  EXPECT_EQ(range_colour(200.0), scale_colour(0.0));
  EXPECT_EQ(range_colour(std::sqrt(33.0)), scale_colour(0.5));
  int before = brightness(range_colour(1.0));
  for (const double range_m : {2.0, 4.0, 8.0, 16.0, 33.0}) {
    EXPECT_LT(brightness(range_colour(range_m)) + 10, before) << range_m;
    before = brightness(range_colour(range_m));
  }
}

TEST(HaloPictureTest, KindsOfCellsAreTold) {
  EXPECT_GT(brightness(HaloColours::kFree), brightness(range_colour(1.0)) + 100);
  EXPECT_EQ(HaloColours::kUnseen[0], HaloColours::kUnseen[2]);
  EXPECT_LT(brightness(HaloColours::kUnseen), brightness(range_colour(33.0)));
}

TEST(HaloPictureTest, UpIsUpAndLeftIsLeft) {
  Halo halo = empty_halo();
  halo.set(cell_at(halo, 35.0, 75.0), 2.0F, 2.0F);     // above, to the left
  halo.set(cell_at(halo, -25.0, -105.0), 9.0F, 9.0F);  // below, right and a little behind
  halo.set(cell_at(halo, 5.0, -5.0), kNone, 12.0F);
  halo.set(cell_at(halo, 85.0, 175.0), 4.0F, 0.0F);
  halo.set(cell_at(halo, -85.0, -175.0), 5.0F, 0.0F);
  const cv::Mat3b picture = halo_picture(halo, kCellPx);
  ASSERT_EQ(picture.cols, 36 * kCellPx);
  ASSERT_GT(picture.rows, 18 * kCellPx);
  EXPECT_EQ(picture(place_of(35.0, 75.0)), range_colour(2.0));
  EXPECT_EQ(picture(place_of(-25.0, -105.0)), range_colour(9.0));
  EXPECT_EQ(picture(place_of(5.0, -5.0)), HaloColours::kFree);
  EXPECT_EQ(picture(place_of(85.0, 175.0)), range_colour(4.0));
  EXPECT_EQ(picture(place_of(-85.0, -175.0)), range_colour(5.0));
  EXPECT_EQ(picture(place_of(35.0, -75.0)), HaloColours::kUnseen);
  EXPECT_EQ(picture(place_of(-25.0, 105.0)), HaloColours::kUnseen);
}

TEST(HaloPictureTest, LinesMarkTheHorizonAndEighthsOfATurn) {
  Halo halo = empty_halo();
  set_all(halo, kNone, 10.0F);
  const cv::Mat3b picture = halo_picture(halo, kCellPx);
  for (const double azimuth_deg : {135.0, 90.0, 45.0, 0.0, -45.0, -90.0, -135.0}) {
    EXPECT_LT(brightness(picture(place_of(50.0, azimuth_deg))), brightness(HaloColours::kFree));
  }
  EXPECT_LT(brightness(picture(place_of(0.0, 22.0))), brightness(HaloColours::kFree));
  EXPECT_EQ(picture(place_of(5.0, 22.0)), HaloColours::kFree);
  EXPECT_EQ(picture(place_of(50.0, 22.0)), HaloColours::kFree);
}

TEST(HaloPictureTest, BelowTheSphereTheScaleIsShown) {
  const cv::Mat3b picture = halo_picture(empty_halo(), kCellPx);
  const cv::Mat3b below = picture.rowRange(18 * kCellPx, picture.rows);
  const auto holds = [&](const cv::Vec3b& colour) {
    return std::find(below.begin(), below.end(), colour) != below.end();
  };
  EXPECT_TRUE(holds(range_colour(1.0)));
  EXPECT_TRUE(holds(range_colour(33.0)));
  EXPECT_TRUE(holds(HaloColours::kFree));
  EXPECT_TRUE(holds(HaloColours::kUnseen));
}

TEST(HaloPictureTest, TheSmallestPicturesAreDrawnToo) {
  EXPECT_EQ(halo_picture(Halo(rad_from_deg(90.0)), 1).cols, 4);
  const cv::Mat3b dot = halo_top_picture(empty_halo(), kBand, Eigen::Matrix3d::Identity(), 5.0, 1);
  EXPECT_EQ(dot.size(), cv::Size(1, 1));
}

TEST(HaloPictureTest, FromAboveForwardIsUpAndLeftIsLeft) {
  Halo halo = empty_halo();
  set_sector(halo, -20.0, 20.0, 8.0F, 8.0F);      // ahead
  set_sector(halo, 70.0, 110.0, 4.0F, 4.0F);      // left
  set_sector(halo, -110.0, -70.0, kNone, 12.5F);  // right
  const cv::Mat3b picture = top_picture_of(halo);
  ASSERT_EQ(picture.size(), cv::Size(kSizePx, kSizePx));
  EXPECT_EQ(picture(place_from_above(7.5, 2.0)), HaloColours::kFree);
  EXPECT_EQ(picture(place_from_above(8.2, 2.0)), range_colour(8.0));
  EXPECT_EQ(picture(place_from_above(12.0, 2.0)), HaloColours::kBeyond);
  EXPECT_EQ(picture(place_from_above(3.5, 88.0)), HaloColours::kFree);
  EXPECT_EQ(picture(place_from_above(4.2, 88.0)), range_colour(4.0));
  EXPECT_EQ(picture(place_from_above(12.0, 88.0)), HaloColours::kBeyond);
  EXPECT_EQ(picture(place_from_above(12.0, -88.0)), HaloColours::kFree);
  expect_dark(picture(place_from_above(13.0, -88.0)));
  expect_dark(picture(place_from_above(8.0, 45.0)));
  EXPECT_EQ(picture(0, 0), cv::Vec3b(255, 255, 255)) << "outside the disc";
}

TEST(HaloPictureTest, FromAboveWhatIsNotSeenIsNotFree) {
  Halo halo = empty_halo();
  set_sector(halo, -30.0, 30.0, 10.0F, 6.0F);
  set_sector(halo, 60.0, 120.0, kNone, 15.0F);
  halo.set(cell_at(halo, 5.0, 85.0), kNone, 0.0F);  // one cell of the sector is unseen
  const cv::Mat3b picture = top_picture_of(halo);
  EXPECT_EQ(picture(place_from_above(5.5, 2.0)), HaloColours::kFree);
  expect_light_grey(picture(place_from_above(8.0, 2.0)));
  EXPECT_EQ(picture(place_from_above(10.2, 2.0)), range_colour(10.0));
  expect_dark(picture(place_from_above(8.0, 85.0)));
  EXPECT_EQ(picture(place_from_above(8.0, 105.0)), HaloColours::kFree);
}

TEST(HaloPictureTest, FromAboveOnlyTheBandCounts) {
  Halo halo = empty_halo();
  set_sector(halo, -30.0, 30.0, kNone, 15.0F);
  halo.set(cell_at(halo, 25.0, 5.0), 3.0F, 3.0F);  // a branch overhead
  EXPECT_EQ(top_picture_of(halo)(place_from_above(8.0, 3.0)), HaloColours::kFree);
}

TEST(HaloPictureTest, FromAboveTheRingIsLevel) {
  // Nose 20 degrees down (a turn about y, which points left): what is 20 degrees above its x axis
  // is level.
  const Eigen::Matrix3d nose_down =
      Eigen::AngleAxisd(rad_from_deg(20.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
  Halo halo = empty_halo();
  set_all(halo, kNone, 15.0F);
  for (const double azimuth_deg : {-15.0, -5.0, 5.0, 15.0}) {
    halo.set(cell_at(halo, 25.0, azimuth_deg), 6.0F, 6.0F);
    halo.set(cell_at(halo, -25.0, azimuth_deg), 3.0F, 3.0F);
  }
  const cv::Mat3b picture = top_picture_of(halo, nose_down);
  EXPECT_EQ(picture(place_from_above(6.2, 2.0)), range_colour(6.0));
  EXPECT_EQ(picture(place_from_above(3.2, 2.0)), HaloColours::kFree);
}

TEST(HaloPictureTest, TheBodyIsInTheMiddle) {
  Halo halo = empty_halo();
  set_all(halo, kNone, 15.0F);
  const cv::Vec3b body = top_picture_of(halo)(200, 200);
  EXPECT_GT(body[2], body[0] + 50);
}

}  // namespace
}  // namespace skyhalo
