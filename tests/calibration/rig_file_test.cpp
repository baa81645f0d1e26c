#include "skyhalo/calibration/rig_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>

#include "skyhalo/geometry/angle.hpp"
#include "support/rig_texts.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::changed;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kRawRig;
using testing::kRectifiedRig;
using ::testing::SizeIs;
using testing::TempFolder;

RigFile read(const std::string& text) {
  const TempFolder folder;
  return read_rig_file(folder.write("rig.yaml", text));
}

PairDescription first_pair(const std::string& text) {
  return read(text).description.pairs.at(0);
}

/// The first pair's `T_body_camera` when that section has these lines.
Pose placed(const std::string& lines) {
  return first_pair(changed(kRawRig, "      position_m: [0.1, -0.05, 0.02]\n", lines))
      .T_body_camera;
}

/// Where the camera's x (right), y (down) and z (forward) point in body (x forward, y left, z up).
void expect_axes(const Pose& T_body_camera,
                 const Eigen::Vector3d& right,
                 const Eigen::Vector3d& down,
                 const Eigen::Vector3d& forward) {
  Eigen::Matrix3d R;
  R << right, down, forward;
  EXPECT_LT((T_body_camera.linear() - R).norm(), 1e-12) << T_body_camera.linear();
}

const Eigen::Vector3d kForward(1, 0, 0);
const Eigen::Vector3d kLeft(0, 1, 0);
const Eigen::Vector3d kUp(0, 0, 1);

TEST(RigFileTest, ARawPairIsReadOff) {
  const RigFile file = read(kRawRig);
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(file.description.name, "made up");
  EXPECT_FALSE(file.description.T_body_imu.has_value());
  ASSERT_THAT(file.description.pairs, SizeIs(1));
  const PairDescription& pair = file.description.pairs[0];
  EXPECT_EQ(pair.name, "front");
  EXPECT_EQ(pair.downscale, 2);
  EXPECT_EQ(pair.min_range_m, 0.5);
  EXPECT_EQ(pair.max_range_m, 20.0);
  EXPECT_EQ(pair.T_body_camera.translation(), Eigen::Vector3d(0.1, -0.05, 0.02));
  const auto& raw = std::get<RawPairDescription>(pair.images);
  EXPECT_EQ(raw.cameras.left.size_px, cv::Size(640, 480));
  const auto& left = std::get<RadialTangentialLens>(raw.cameras.left.lens);
  EXPECT_EQ(left.intrinsics().fx_px, 400.0);
  EXPECT_EQ(left.intrinsics().fy_px, 404.0);
  EXPECT_EQ(left.intrinsics().cx_px, 319.5);
  EXPECT_EQ(left.intrinsics().cy_px, 241.0);
  EXPECT_THAT(left.distortion(), ElementsAre(-0.2, 0.05, 0.001, -0.002, 0, 0, 0, 0));
  const auto& right = std::get<RadialTangentialLens>(raw.cameras.right.lens);
  EXPECT_EQ(right.intrinsics().fx_px, 410.0);
  EXPECT_THAT(right.distortion(), ::testing::Each(0.0));
  EXPECT_EQ(raw.cameras.T_right_left.translation(), Eigen::Vector3d(-0.1, 0, 0));
  EXPECT_EQ(raw.rectify_to.model, PairModelKind::kPinhole);
  EXPECT_NEAR(*raw.rectify_to.hfov_rad, 1.0471975511965976, 1e-15);
  EXPECT_FALSE(raw.rectify_to.vfov_rad.has_value());
  EXPECT_FALSE(raw.rectify_to.size_px.has_value());
}

TEST(RigFileTest, WhatIsLeftOutIsLeftToOthers) {
  const PairDescription pair = first_pair(kRectifiedRig);
  EXPECT_FALSE(pair.downscale.has_value());
  EXPECT_FALSE(pair.rcrop_px.has_value());
  EXPECT_FALSE(pair.min_range_m.has_value());
  EXPECT_FALSE(pair.max_range_m.has_value());
  EXPECT_THAT(pair.masks_px, IsEmpty());
  EXPECT_EQ(pair.line_time_s, 0.0);
  const auto& rectified = std::get<RectifiedPairDescription>(pair.images);
  EXPECT_EQ(std::get<PinholePair>(rectified.model).disparity_offset_px, 0.0);
  const auto raw =
      std::get<RawPairDescription>(first_pair(changed(kRawRig, "      hfov_deg: 60\n", "")).images);
  EXPECT_FALSE(raw.rectify_to.hfov_rad.has_value());
}

TEST(RigFileTest, EveryOptionalKeyOfAPairIsRead) {
  const PairDescription pair = first_pair(changed(kRawRig,
                                                  "    downscale: 2\n",
                                                  "    downscale: 16\n"
                                                  "    rcrop_px: 0\n"
                                                  "    masks_px: [[1, 2, 3, 4], [-5, 6, 7, 8]]\n"
                                                  "    line_time_s: 2.5e-5\n"));
  EXPECT_EQ(pair.downscale, 16);
  EXPECT_EQ(pair.rcrop_px, 0);
  EXPECT_THAT(pair.masks_px, ElementsAre(cv::Rect(1, 2, 3, 4), cv::Rect(-5, 6, 7, 8)));
  EXPECT_EQ(pair.line_time_s, 2.5e-5);
  const auto raw = std::get<RawPairDescription>(
      first_pair(changed(kRawRig,
                         "model: pinhole\n      hfov_deg: 60",
                         "model: spherical\n      vfov_deg: 90\n      size_px: [320, 200]"))
          .images);
  EXPECT_EQ(raw.rectify_to.model, PairModelKind::kSpherical);
  EXPECT_NEAR(*raw.rectify_to.vfov_rad, 1.5707963267948966, 1e-15);
  EXPECT_EQ(raw.rectify_to.size_px, cv::Size(320, 200));
}

TEST(RigFileTest, ARectifiedPinholePairIsReadOff) {
  const auto rectified = std::get<RectifiedPairDescription>(
      first_pair(changed(kRectifiedRig,
                         "baseline_m: 0.1",
                         "baseline_m: 0.1\n      disparity_offset_px: -1.5"))
          .images);
  EXPECT_EQ(rectified.size_px, cv::Size(640, 480));
  const auto& model = std::get<PinholePair>(rectified.model);
  EXPECT_EQ(model.focal_px, 400.0);
  EXPECT_EQ(model.principal_u_px, 319.5);
  EXPECT_EQ(model.principal_v_px, 239.5);
  EXPECT_EQ(model.baseline_m, 0.1);
  EXPECT_EQ(model.disparity_offset_px, -1.5);
}

TEST(RigFileTest, ARectifiedSphericalPairIsReadOff) {
  const auto rectified = std::get<RectifiedPairDescription>(
      first_pair(changed(changed(kRectifiedRig, "model: pinhole", "model: spherical"),
                         "focal_px: 400",
                         "delta_theta_rad: [0.004, 0.003]"))
          .images);
  const auto& model = std::get<SphericalPair>(rectified.model);
  EXPECT_EQ(model.delta_theta_u_rad, 0.004);
  EXPECT_EQ(model.delta_theta_v_rad, 0.003);
  EXPECT_EQ(model.principal_u_px, 319.5);
  EXPECT_EQ(model.principal_v_px, 239.5);
  EXPECT_EQ(model.baseline_m, 0.1);
}

TEST(RigFileTest, ACameraWithoutATurnLooksForward) {
  const Pose T = placed("      position_m: [1, 2, 3]\n");
  expect_axes(T, -kLeft, -kUp, kForward);
  EXPECT_EQ(T.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(RigFileTest, YawTurnsToTheLeft) {
  expect_axes(placed("      position_m: [0, 0, 0]\n      yaw_deg: 90\n"), kForward, -kUp, kLeft);
  // 30 degrees: forward becomes (cos, sin, 0), right (sin, -cos, 0).
  const double c = 0.8660254037844387;
  expect_axes(
      placed("      position_m: [0, 0, 0]\n      yaw_deg: 30\n"), {0.5, -c, 0}, -kUp, {c, 0.5, 0});
}

TEST(RigFileTest, PitchTurnsDownwards) {
  // The vehicle's front is at the top of the image: down in the image is backwards.
  expect_axes(
      placed("      position_m: [0, 0, 0]\n      pitch_deg: 90\n"), -kLeft, -kForward, -kUp);
  const double c = 0.8660254037844387;
  expect_axes(placed("      position_m: [0, 0, 0]\n      pitch_deg: 30\n"),
              -kLeft,
              {-0.5, 0, -c},
              {c, 0, -0.5});
}

TEST(RigFileTest, RollTurnsToTheRight) {
  // The camera's right side goes down.
  expect_axes(placed("      position_m: [0, 0, 0]\n      roll_deg: 90\n"), -kUp, kLeft, kForward);
}

TEST(RigFileTest, YawComesFirstThenPitchThenRoll) {
  // Turned left, then its nose down, then rolled about the axis that now points down: the camera's
  // right side, which after yaw and pitch points forward, goes round to the vehicle's right.
  expect_axes(placed("      position_m: [0, 0, 0]\n"
                     "      yaw_deg: 90\n      pitch_deg: 90\n      roll_deg: 90\n"),
              -kLeft,
              -kForward,
              -kUp);
  // Yaw and pitch alone: a camera on the left side whose nose goes down.
  expect_axes(placed("      position_m: [0, 0, 0]\n      yaw_deg: 90\n      pitch_deg: 90\n"),
              kForward,
              -kLeft,
              -kUp);
}

TEST(RigFileTest, TurnsOfAnImuAndOfTheLeftCameraStartUnturned) {
  const RigFile file = read(changed(kRawRig,
                                    "pairs:\n",
                                    "T_body_imu:\n  position_m: [1, 2, 3]\n  yaw_deg: 90\n"
                                    "pairs:\n"));
  ASSERT_TRUE(file.description.T_body_imu.has_value());
  const Eigen::Vector3d p = *file.description.T_body_imu * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((p - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  const std::size_t from = kRawRig.find("      - [1, 0, 0, -0.1]");
  const std::size_t to = kRawRig.find("    rectify_to:");
  std::string text = kRawRig;
  text.replace(from, to - from, "      position_m: [-0.1, 0.01, 0.02]\n");
  const Pose T = std::get<RawPairDescription>(first_pair(text).images).cameras.T_right_left;
  EXPECT_EQ(T.linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(T.translation(), Eigen::Vector3d(-0.1, 0.01, 0.02));
}

TEST(RigFileTest, AMatrixIsFourRowsOrSixteenNumbers) {
  const std::string rows =
      "      - [0, 0, 1, 1]\n      - [-1, 0, 0, 2]\n      - [0, -1, 0, 3]\n      - [0, 0, 0, 1]\n";
  const std::string flat = "      [0, 0, 1, 1, -1, 0, 0, 2, 0, -1, 0, 3, 0, 0, 0, 1]\n";
  for (const std::string& text : {rows, flat}) {
    const Pose T = placed(text);
    expect_axes(T, -kLeft, -kUp, kForward);
    EXPECT_EQ(T.translation(), Eigen::Vector3d(1, 2, 3));
  }
}

TEST(RigFileTest, AMatrixIsTakenAsItIsWhateverTheCameraLooksAt) {
  // Only `position_m` starts from a camera that looks forward.
  const Pose T = placed("      [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  EXPECT_EQ(T.linear(), Eigen::Matrix3d::Identity());
}

TEST(RigFileTest, ASlightlyOddRotationIsMendedAloud) {
  const TempFolder folder;
  const auto path = folder.write("rig.yaml", changed(kRawRig, "[0, 1, 0, 0]", "[0, 1.0001, 0, 0]"));
  const RigFile file = read_rig_file(path);
  ASSERT_THAT(file.warnings, SizeIs(1));
  EXPECT_THAT(file.warnings[0],
              HasSubstr(path.string() + ":13: pairs[0].T_right_left: "
                                        "the rotation is not orthonormal by 0.0002"));
  const auto& raw = std::get<RawPairDescription>(file.description.pairs[0].images);
  EXPECT_LT((raw.cameras.T_right_left.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(RigFileTest, DigitsThatAFilePrintsNeedNoWarning) {
  EXPECT_THAT(read(changed(kRawRig, "[0, 1, 0, 0]", "[0, 1.000004, 0, 0]")).warnings, IsEmpty());
}

TEST(RigFileTest, LoadingARigResolvesIt) {
  const TempFolder folder;
  const StereoRig rig = load_rig(folder.write("rig.yaml", kRawRig));
  ASSERT_THAT(rig.pairs, SizeIs(1));
  EXPECT_TRUE(rig.pairs[0].raw.has_value());
  EXPECT_NEAR(baseline_m(rig.pairs[0].model), 0.1, 1e-12);
}

}  // namespace
}  // namespace skyhalo
