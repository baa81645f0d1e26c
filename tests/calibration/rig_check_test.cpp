#include "skyhalo/calibration/rig_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "skyhalo/calibration/imported_cameras.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

using Warnings = std::vector<std::string>;

RawCamera camera() {
  return {{640, 480}, RadialTangentialLens({400.0, 400.0, 319.5, 239.5}, {})};
}

/// A good pair, 0.1 m apart, that looks forward: 77 degrees across.
PairDescription good_pair() {
  return {
      .name = "front",
      .images =
          RawPairDescription{
              {camera(), camera(), make_pose(Eigen::Matrix3d::Identity(), {-0.1, 0.0, 0.0})}, {}},
      .T_body_camera = make_pose(R_body_camera(Facing::kForward), {0.1, -0.05, 0.0})};
}

RawPairDescription& raw(PairDescription& pair) {
  return std::get<RawPairDescription>(pair.images);
}

RigReport report(const PairDescription& pair) {
  return check_rig({.name = "rig", .T_body_imu = {}, .pairs = {pair}}, {});
}

void expect_warning(const PairDescription& pair, const std::string& words) {
  EXPECT_THAT(report(pair).warnings, ElementsAre(HasSubstr(words))) << words;
}

/// A warning, and the reason why the pair cannot be used.
void expect_unusable(const PairDescription& pair, const std::string& words) {
  const RigReport result = report(pair);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr(words)));
  EXPECT_THAT(result.unusable, ElementsAre(::testing::StartsWith("pairs[0].T_right_left: ")));
  EXPECT_THAT(result.pairs, IsEmpty());
}

/// The turn of a camera that looks forward, about its own axis (roll to the right) and then up.
Eigen::Matrix3d turned(double up_deg, double roll_deg) {
  return (Eigen::AngleAxisd(rad_from_deg(-up_deg), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rad_from_deg(roll_deg), Eigen::Vector3d::UnitX()))
             .toRotationMatrix() *
         R_body_camera(Facing::kForward);
}

TEST(RigCheckTest, AGoodPairGivesNoWarning) {
  EXPECT_THAT(report(good_pair()).warnings, IsEmpty());
  EXPECT_THAT(report(good_pair()).unusable, IsEmpty());
}

TEST(RigCheckTest, ABaselineInMillimetres) {
  PairDescription pair = good_pair();
  raw(pair).cameras.T_right_left.translation() *= 1000.0;
  expect_warning(pair,
                 "pair front: the baseline of 100 m looks like millimetres; as such it would "
                 "be 0.1 m");
  pair.images =
      RectifiedPairDescription{{640, 480}, PinholePair{.focal_px = 400, .baseline_m = 120.0}};
  expect_warning(pair, "the baseline of 120 m looks like millimetres");
}

TEST(RigCheckTest, AVeryShortBaseline) {
  PairDescription pair = good_pair();
  raw(pair).cameras.T_right_left.translation() *= 0.01;
  expect_warning(pair, "the baseline of 0.001 m is very short");
}

TEST(RigCheckTest, APlaceInMillimetres) {
  PairDescription pair = good_pair();
  pair.T_body_camera.translation() = Eigen::Vector3d(300.0, 0.0, -400.0);
  expect_warning(pair, "the camera stands 500 m from the body's origin");
}

TEST(RigCheckTest, SwappedCamerasAndInvertedExtrinsics) {
  // With parallel cameras the two mistakes give the same numbers.
  PairDescription pair = good_pair();
  raw(pair).cameras.T_right_left = raw(pair).cameras.T_right_left.inverse();
  expect_unusable(pair, "left and right are swapped, or T_right_left is inverted");
}

TEST(RigCheckTest, CamerasAboveEachOther) {
  PairDescription pair = good_pair();
  raw(pair).cameras.T_right_left.translation() = Eigen::Vector3d(0.0, -0.1, 0.0);
  expect_unusable(pair, "the baseline lies 90 degrees off the image rows: the cameras stand above");
}

/// The poses of EuRoC's cameras in its IMU's frame (x up, z forward), rounded.
Pose euroc_pose(double y_m) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return make_pose(R, {-0.02, y_m, 0.01});
}

TEST(RigCheckTest, PosesGivenTheWrongWayRound) {
  const Pose T_left_imu = euroc_pose(-0.065).inverse();
  const Pose T_right_imu = euroc_pose(0.045).inverse();
  PairDescription pair = good_pair();
  // Taken for T_imu_left and T_imu_right, the left camera in the right one is:
  raw(pair).cameras.T_right_left = T_right_imu.inverse() * T_left_imu;
  pair.T_body_camera = T_right_imu;
  EXPECT_THAT(report(pair).warnings,
              ::testing::Contains(HasSubstr("the camera poses look inverted")).Times(1));
}

TEST(RigCheckTest, TheAxesOfAnImu) {
  PairDescription pair = good_pair();
  pair.T_body_camera = euroc_pose(0.045);
  raw(pair).cameras.T_right_left = euroc_pose(0.045).inverse() * euroc_pose(-0.065);
  expect_warning(pair, "looks up; is T_body_camera given in the axes of an IMU?");
}

TEST(RigCheckTest, IntrinsicsOfAnotherImageSize) {
  PairDescription pair = good_pair();
  raw(pair).cameras.left.size_px = cv::Size(1280, 960);
  raw(pair).cameras.right.size_px = cv::Size(1280, 960);
  const RigReport result = report(pair);
  EXPECT_THAT(result.warnings,
              ::testing::IsSupersetOf({HasSubstr("pair front: left: the principal point"),
                                       HasSubstr("pair front: right: the principal point")}));
  EXPECT_EQ(std::count_if(result.warnings.begin(),
                          result.warnings.end(),
                          [](const auto& w) { return w.find("another image size") != w.npos; }),
            2);
}

TEST(RigCheckTest, CamerasThatDiffer) {
  PairDescription pair = good_pair();
  raw(pair).cameras.right.lens = RadialTangentialLens({450.0, 450.0, 319.5, 239.5}, {});
  expect_warning(pair, "the focal lengths of left and right differ by more than 10 %");
  pair = good_pair();
  raw(pair).cameras.left.lens = RadialTangentialLens({400.0, 350.0, 319.5, 239.5}, {});
  expect_warning(pair, "left: fx and fy differ by more than 10 %");
  pair = good_pair();
  raw(pair).cameras.left.size_px = cv::Size(648, 480);
  expect_warning(pair, "the images of left and right differ in size");
}

TEST(RigCheckTest, ACameraThatLooksUp) {
  PairDescription pair = good_pair();
  pair.T_body_camera.linear() = turned(90.0, 0.0);
  expect_warning(pair, "pair front: looks up");
}

TEST(RigCheckTest, ACameraOnItsSideOrUpsideDown) {
  PairDescription pair = good_pair();
  for (const double roll_deg : {-90.0, 90.0, 60.0}) {
    pair.T_body_camera.linear() = turned(0.0, roll_deg);
    expect_warning(pair, "pair front: lies on its side");
  }
  pair.T_body_camera.linear() = turned(10.0, 180.0);
  expect_warning(pair, "pair front: hangs upside down");
  pair.T_body_camera.linear() = turned(-50.0, 180.0);
  expect_warning(pair, "pair front: hangs upside down");
  pair.T_body_camera.linear() = turned(-50.0, 90.0);
  expect_warning(pair, "pair front: lies on its side");
}

TEST(RigCheckTest, ANoseThatPointsUpOrDownIsNoTurnOnTheSide) {
  PairDescription pair = good_pair();
  for (const double roll_deg : {-20.0, 0.0, 20.0}) {
    for (const double up_deg : {-90.0, -75.0, -59.0, -50.0, -45.0, -30.0, 0.0, 30.0, 45.0, 55.0}) {
      pair.T_body_camera.linear() = turned(up_deg, roll_deg);
      EXPECT_THAT(report(pair).warnings, IsEmpty()) << up_deg << " up, rolled " << roll_deg;
    }
  }
}

TEST(RigCheckTest, AFieldWiderThanTheCameras) {
  // 120 degrees are 2 tan 60 = 3.46 of the tangent across and, at that pixel, 480/640 of it
  // upright; the cameras show 640/400 = 1.6 by 1.2: 0.21 of the area.
  PairDescription pair = good_pair();
  raw(pair).rectify_to = {.hfov_rad = rad_from_deg(120.0), .size_px = cv::Size(640, 480)};
  expect_warning(pair, "the cameras fill only 2");
  EXPECT_NEAR(report(pair).pairs.at(0).seen_share, 0.2133, 0.01);
}

TEST(RigCheckTest, APairThatCannotBeUsedLeavesTheOthers) {
  PairDescription wide = good_pair();
  wide.name = "wide";
  raw(wide).rectify_to.hfov_rad = rad_from_deg(170.0);
  const RigReport result =
      check_rig({.name = "rig", .T_body_imu = {}, .pairs = {good_pair(), wide}}, {});
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_THAT(result.unusable,
              ElementsAre(::testing::StartsWith("pairs[1].rectify_to.hfov_deg: ")));
  ASSERT_THAT(result.pairs, SizeIs(1));
  EXPECT_EQ(result.pairs[0].name, "front");
}

TEST(RigCheckTest, ThePinholeNumbers) {
  PairDescription pair = good_pair();
  pair.images = RectifiedPairDescription{
      {1280, 720},
      PinholePair{
          .focal_px = 640, .principal_u_px = 639.5, .principal_v_px = 359.5, .baseline_m = 0.1}};
  pair.downscale = 4;
  const RigReport result =
      check_rig({.name = "rig", .T_body_imu = {}, .pairs = {pair}},
                {.downscale = 2, .max_disparity_px = 64, .delta_d_px = 0.25, .voxel_m = 0.5});
  const PairReport& front = result.pairs.at(0);
  EXPECT_FALSE(front.raw);
  EXPECT_EQ(front.downscale, 4);
  EXPECT_NEAR(deg_from_rad(front.field.horizontal_rad), 90.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(front.field.vertical_rad), 58.7155070856, 1e-9);  // 2 atan(360/640)
  EXPECT_LT((front.axis_body - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((front.rows_body - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_EQ(front.position_body_m, Eigen::Vector3d(0.1, -0.05, 0.0));
  EXPECT_EQ(front.seen_share, 1.0);
  EXPECT_NEAR(front.min_range_m, 0.25, 1e-12);  // f B/d of a quarter of the focal length: 16/64
  // sqrt(0.5 * 0.1 * 160 / 0.25) = sqrt(32)
  EXPECT_NEAR(front.range_of_one_cell_m, 5.656854249492381, 1e-12);
  pair.downscale.reset();
  EXPECT_NEAR(report(pair).pairs.at(0).min_range_m, 0.5, 1e-12);  // the settings' 2
}

TEST(RigCheckTest, DirectionsInWords) {
  const double c = 0.8660254037844387;
  EXPECT_EQ(in_words({1, 0, 0}), "forward");
  EXPECT_EQ(in_words({0, 2, 0}), "left");
  EXPECT_EQ(in_words({0, -0.5, 0}), "right");
  EXPECT_EQ(in_words({-1, 0, 0}), "back");
  EXPECT_EQ(in_words({-1, -0.0, 0}), "back");
  EXPECT_EQ(in_words({0, 0, 1}), "up");
  EXPECT_EQ(in_words({0.01, 0, -1}), "down");
  EXPECT_EQ(in_words({c, 0.5, 0}), "forward, 30.0 degrees towards left");
  EXPECT_EQ(in_words({-0.5, c, 0}), "left, 30.0 degrees towards back");
  EXPECT_EQ(in_words({-0.5, -c, 0}), "right, 30.0 degrees towards back");
  EXPECT_EQ(in_words({-c, -0.5, 0}), "back, 30.0 degrees towards right");
  EXPECT_EQ(in_words({-c, 0.5, 0}), "back, 30.0 degrees towards left");
  EXPECT_EQ(in_words({c, 0, -0.5}), "forward, 30.0 degrees down");
  EXPECT_EQ(in_words({0, -c, 0.5}), "right, 30.0 degrees up");
}

TEST(RigCheckTest, TheSphericalNumbers) {
  PairDescription pair = good_pair();
  pair.images = RectifiedPairDescription{{1000, 500},
                                         SphericalPair{.delta_theta_u_rad = 0.0025,
                                                       .delta_theta_v_rad = 0.002,
                                                       .principal_u_px = 499.5,
                                                       .principal_v_px = 249.5,
                                                       .baseline_m = 0.1}};
  const PairReport front = report(pair).pairs.at(0);
  EXPECT_NEAR(front.field.horizontal_rad, 2.5, 1e-12);
  EXPECT_NEAR(front.field.vertical_rad, 1.0, 1e-12);
  EXPECT_NEAR(front.min_range_m, 0.1 / 0.3313894052, 1e-9);  // B/tan(64 * 0.005 rad)
  // B sqrt(0.5/(0.1 * 0.005 * 0.5) - 1) = 0.1 sqrt(1999)
  EXPECT_NEAR(front.range_of_one_cell_m, 4.4710177812, 1e-9);
}

}  // namespace
}  // namespace skyhalo
