#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "skyhalo/calibration/imported_cameras.hpp"
#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "support/expect_error.hpp"
#include "support/rig_texts.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::StartsWith;
using testing::TempFolder;

RawCamera camera() {
  return {{640, 480}, RadialTangentialLens({400.0, 400.0, 319.5, 239.5}, {})};
}

/// Two cameras whose right one stands at (1, 2, 3) and looks forward.
PairDescription raw_pair(const Eigen::Matrix3d& R_right_left, const Eigen::Vector3d& left_m) {
  return {.name = "front",
          .images = RawPairDescription{{camera(), camera(), make_pose(R_right_left, left_m)}, {}},
          .T_body_camera = make_pose(R_body_camera(Facing::kForward), {1.0, 2.0, 3.0})};
}

StereoPair resolved(const PairDescription& pair) {
  return resolve({.name = "rig", .T_body_imu = {}, .pairs = {pair}}).pairs.at(0);
}

std::string refusal(const PairDescription& pair, std::size_t index = 0) {
  RigDescription rig;
  const PairDescription good = raw_pair(Eigen::Matrix3d::Identity(), {-0.1, 0.0, 0.0});
  rig.pairs.assign(index, good);
  rig.pairs.push_back(pair);
  return message_of([&] { (void)resolve(rig); });
}

void expect_axes(const Pose& T_body_camera,
                 const Eigen::Vector3d& right,
                 const Eigen::Vector3d& down,
                 const Eigen::Vector3d& forward) {
  Eigen::Matrix3d R;
  R << right, down, forward;
  EXPECT_LT((T_body_camera.linear() - R).norm(), 1e-12) << T_body_camera.linear();
  EXPECT_EQ(T_body_camera.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(ResolveRigTest, ALevelPairKeepsItsCamera) {
  const StereoPair pair = resolved(raw_pair(Eigen::Matrix3d::Identity(), {-0.1, 0.0, 0.0}));
  expect_axes(pair.T_body_camera, {0, -1, 0}, {0, 0, -1}, {1, 0, 0});
  EXPECT_NEAR(baseline_m(pair.model), 0.1, 1e-12);
  ASSERT_TRUE(pair.raw.has_value());
  EXPECT_LT((pair.raw->R_left_cam - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(ResolveRigTest, ATiltedBaselineTiltsTheRows) {
  // The left camera stands to the left of the right one and above it, 30 degrees off its rows, so
  // the new rows run along (cos 30, sin 30) of right and down.
  const double c = 0.8660254037844387;
  const StereoPair pair = resolved(raw_pair(Eigen::Matrix3d::Identity(), {-0.2 * c, -0.1, 0.0}));
  expect_axes(pair.T_body_camera, {0, -c, -0.5}, {0, 0.5, -c}, {1, 0, 0});
  EXPECT_NEAR(baseline_m(pair.model), 0.2, 1e-12);
}

TEST(ResolveRigTest, TheRectifiedCameraLooksBetweenTheTwo) {
  // The left camera looks 20 degrees up: turned about x (right) by 20 degrees, its axis is
  // (0, -sin 20, cos 20) of the right one. The middle is 10 degrees up.
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(rad_from_deg(20.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  const StereoPair pair = resolved(raw_pair(R, {-0.1, 0.0, 0.0}));
  const double s = std::sin(rad_from_deg(10.0));
  const double c = std::cos(rad_from_deg(10.0));
  expect_axes(pair.T_body_camera, {0, -1, 0}, {s, 0, -c}, {c, 0, s});
  // Seen from the raw cameras, the common axis is 10 degrees up for the right one, down for the
  // left one.
  EXPECT_LT((pair.raw->R_right_cam.col(2) - Eigen::Vector3d(0, -s, c)).norm(), 1e-12);
  EXPECT_LT((pair.raw->R_left_cam.col(2) - Eigen::Vector3d(0, s, c)).norm(), 1e-12);
}

TEST(ResolveRigTest, ARectifiedPairStaysAsItIs) {
  const PinholePair model{
      .focal_px = 400, .principal_u_px = 1, .principal_v_px = 2, .baseline_m = 0.3};
  const StereoPair pair =
      resolved({.name = "left",
                .images = RectifiedPairDescription{{640, 480}, model},
                .T_body_camera = make_pose(R_body_camera(Facing::kLeft), {1.0, 2.0, 3.0})});
  EXPECT_FALSE(pair.raw.has_value());
  EXPECT_EQ(pair.image_size_px, cv::Size(640, 480));
  EXPECT_EQ(std::get<PinholePair>(pair.model).focal_px, 400.0);
  expect_axes(pair.T_body_camera, {1, 0, 0}, {0, 0, -1}, {0, 1, 0});
}

TEST(ResolveRigTest, EverythingElseIsPassedOn) {
  PairDescription pair = raw_pair(Eigen::Matrix3d::Identity(), {-0.1, 0.0, 0.0});
  pair.downscale = 4;
  pair.rcrop_px = 5;
  pair.masks_px = {cv::Rect(1, 2, 3, 4)};
  pair.min_range_m = 0.5;
  pair.max_range_m = 6.0;
  pair.line_time_s = 7e-5;
  const StereoPair result = resolved(pair);
  EXPECT_EQ(result.name, "front");
  EXPECT_EQ(result.downscale, 4);
  EXPECT_EQ(result.rcrop_px, 5);
  EXPECT_THAT(result.masks_px, ElementsAre(cv::Rect(1, 2, 3, 4)));
  EXPECT_EQ(result.min_range_m, 0.5);
  EXPECT_EQ(result.max_range_m, 6.0);
  EXPECT_EQ(result.line_time_s, 7e-5);
  EXPECT_EQ(result.raw->left.size_px, cv::Size(640, 480));
}

TEST(ResolveRigTest, AnImpossiblePairIsNamedByItsKey) {
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  EXPECT_THAT(refusal(raw_pair(level, {0.1, 0.0, 0.0})),
              AllOf(StartsWith("pairs[0].T_right_left: "), HasSubstr("swapped")));
  EXPECT_THAT(refusal(raw_pair(level, {0.0, 0.0, 0.0})),
              AllOf(StartsWith("pairs[0].T_right_left: "), HasSubstr("zero")));
  EXPECT_THAT(refusal(raw_pair(level, {0.0, -0.1, 0.0}), 2), StartsWith("pairs[2].T_right_left: "));
  const Eigen::Matrix3d back =
      Eigen::AngleAxisd(rad_from_deg(180.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_THAT(refusal(raw_pair(back, {-0.1, 0.0, 0.0})),
              AllOf(StartsWith("pairs[0].T_right_left: "), HasSubstr("same way")));
  PairDescription wide = raw_pair(level, {-0.1, 0.0, 0.0});
  std::get<RawPairDescription>(wide.images).rectify_to.hfov_rad = rad_from_deg(160.0);
  EXPECT_THAT(refusal(wide, 1), StartsWith("pairs[1].rectify_to.hfov_deg: "));
  EXPECT_THAT(message_of([] { (void)resolve({}); }), StartsWith("pairs: "));
}

TEST(ResolveRigTest, LoadingAddsFileAndLine) {
  const TempFolder folder;
  const auto file =
      folder.write("rig.yaml", testing::changed(testing::kRawRig, "0, -0.1]", "0, 0.1]"));
  EXPECT_THAT(message_of([&] { (void)load_rig(file); }),
              StartsWith(file.string() + ":13: pairs[0].T_right_left: the left camera"));
}

}  // namespace
}  // namespace skyhalo
