#include "skyhalo/calibration/kitti_rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::expect_matrix;
using testing::expect_refused;
using ::testing::HasSubstr;
using testing::message_of;
using testing::recorded_data;
using testing::replaced;
using testing::TempFolder;

const std::string kCameras =
    "calib_time: 09-Jan-2012 13:57:47\n"
    "S_rect_00: 1.242000e+03 3.750000e+02\n"
    "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_00: 256 0 160 0 0 256 48 0 0 0 1 0\n"
    "S_rect_01: 1.242000e+03 3.750000e+02\n"
    "P_rect_01: 256 0 160 -128 0 256 48 0 0 0 1 0\n";

const RectifiedPairDescription& images(const RigDescription& rig) {
  return std::get<RectifiedPairDescription>(rig.pairs.at(0).images);
}

TEST(KittiRigTest, ARawDayGivesARectifiedPair) {
  // Camera 00 is at (0.25, 0.25, -0.125) of the scanner, that at (0.75, 0, 0.5) of the INS, and the
  // right camera half a metre to camera 00's right.
  const TempFolder folder;
  (void)folder.write("calib_cam_to_cam.txt", kCameras);
  (void)folder.write("calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.25 -0.125 -0.25\n");
  (void)folder.write("calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: -0.75 0 -0.5\n");
  for (const auto& path : {folder.path(), folder.path() / "calib_cam_to_cam.txt"}) {
    const RigDescription rig = read_kitti_raw_rig(path, KittiPair::kGrey);
    EXPECT_EQ(images(rig).size_px, cv::Size(1242, 375));
    EXPECT_EQ(rig.pairs[0].name, "front");
    expect_matrix(rig.pairs[0].T_body_camera.translation(), Eigen::Vector3d(1.0, -0.25, 0.375));
    ASSERT_TRUE(rig.T_body_imu);
    expect_matrix(rig.T_body_imu->matrix(), Eigen::Matrix4d::Identity(), 0.0);
    const auto pair = std::get<PinholePair>(images(rig).model);
    EXPECT_EQ(pair.focal_px, 256.0);
    EXPECT_EQ(pair.baseline_m, 0.5);
  }
}

TEST(KittiRigTest, CamerasAloneLookForwardFromTheOrigin) {
  const TempFolder folder;
  const auto file = folder.write("calib_cam_to_cam.txt", kCameras);
  const RigDescription rig = read_kitti_raw_rig(file, KittiPair::kGrey);
  EXPECT_FALSE(rig.T_body_imu);
  expect_matrix(rig.pairs.at(0).T_body_camera.matrix(),
                make_pose(R_body_camera(Facing::kForward), Eigen::Vector3d::Zero()).matrix(),
                0.0);
  // Half of the way to the INS is a mistake.
  (void)folder.write("calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.25 -0.125 -0.25\n");
  EXPECT_THAT(message_of([&] { (void)read_kitti_raw_rig(file, KittiPair::kGrey); }),
              HasSubstr("calib_imu_to_velo.txt"));
}

TEST(KittiRigTest, WhatIsWrongInARawFileIsNamed) {
  const auto read = [](const std::filesystem::path& file) {
    (void)read_kitti_raw_rig(file, KittiPair::kGrey);
  };
  expect_refused(
      kCameras,
      "calib_cam_to_cam.txt",
      {{"S_rect_00", "S", {"S_rect_00: this key is missing"}},
       {"S_rect_01", "S", {"S_rect_01: this key is missing"}},
       {"S_rect_01: 1.242", "S_rect_01: 1.241", {":5: S_rect_01: the image size"}},
       {"S_rect_01: 1.242000e+03 3.75", "S_rect_01: 3.75", {":5: S_rect_01: expected 2"}},
       {"S_rect_01: 1.242", "S_rect_01: -1.242", {":5: S_rect_01: expected a whole"}},
       {"S_rect_01: 1.242", "S_rect_01: 1.2425", {":5: S_rect_01: expected a whole"}},
       {"S_rect_01: 1.242000e+03", "S_rect_01: 16385", {":5: S_rect_01: expected", "1...16384"}},
       {"-128", "0", {":6: P_rect_01"}},
       {"-128", "nan", {":6: P_rect_01", "nan"}}},
      read);
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read(folder.write("empty.txt", "")); }), HasSubstr("empty.txt"));
  EXPECT_THAT(message_of([&] { read(folder.path() / "none.txt"); }), HasSubstr("no such file"));
}

/// The same geometry as the raw files above, but with the colour cameras' numbers.
const std::string kTracking =
    "P0: 256 0 160 0 0 256 48 0 0 0 1 0\n"
    "P2: 256 0 160 0 0 256 48 0 0 0 1 0  \n"
    "P3: 256 0 160 -128 0 256 48 0 0 0 1 0\n"
    "R_rect 1 0 0 0 1 0 0 0 1\n"
    "Tr_velo_cam 0 -1 0 0.25 0 0 -1 -0.125 1 0 0 -0.25\n"
    "Tr_imu_velo 1 0 0 -0.75 0 1 0 0 0 0 1 -0.5\n\n";

TEST(KittiRigTest, ATrackingFileGivesTheColourPairInBothSpellings) {
  const TempFolder folder;
  const std::string other = replaced(
      replaced(replaced(kTracking, "R_rect", "R0_rect:"), "Tr_velo_cam", "Tr_velo_to_cam:"),
      "Tr_imu_velo",
      "Tr_imu_to_velo:");
  for (const std::string& text : {kTracking, other}) {
    const RigDescription rig =
        read_kitti_tracking_rig(folder.write("0003.txt", text), cv::Size(1242, 375));
    EXPECT_EQ(images(rig).size_px, cv::Size(1242, 375));
    EXPECT_EQ(std::get<PinholePair>(images(rig).model).baseline_m, 0.5);
    expect_matrix(rig.pairs.at(0).T_body_camera.translation(), Eigen::Vector3d(1.0, -0.25, 0.375));
    ASSERT_TRUE(rig.T_body_imu);
  }
}

TEST(KittiRigTest, WhatIsWrongInATrackingFileIsNamed) {
  const auto read = [](const std::filesystem::path& file) {
    (void)read_kitti_tracking_rig(file, cv::Size(1242, 375));
  };
  expect_refused(kTracking,
                 "0003.txt",
                 {{"P2", "Q", {"P2: this key is missing"}},
                  {"R_rect", "Q", {"R_rect: this key is missing", "R0_rect"}},
                  {"Tr_velo_cam", "Q", {"Tr_velo_cam: this key is missing", "Tr_velo_to_cam"}},
                  {"Tr_imu_velo", "Q", {"Tr_imu_velo: this key is missing", "Tr_imu_to_velo"}},
                  {"-0.5\n", "\n", {":6: Tr_imu_velo: expected 12 numbers, found 11"}},
                  {"-0.75", "nan", {":6: Tr_imu_velo", "nan"}},
                  {"Tr_velo_cam 0", "Tr_velo_cam 0.1", {":5: Tr_velo_cam: its first three"}},
                  {"-128", "0", {":3: P3: the right camera"}}},
                 read);
  const TempFolder folder;
  EXPECT_THAT(
      message_of([&] {
        (void)read_kitti_tracking_rig(folder.write("0003.txt", kTracking), std::nullopt);
      }),
      AllOf(
          HasSubstr("0003.txt"), HasSubstr("the size of the images"), HasSubstr("must be given")));
}

TEST(KittiRigSystem, TheRecordedDayGivesWhatItsCalibrationGives) {
  const auto folder = recorded_data() / "kitti_raw/2011_09_26";
  SKYHALO_SKIP_WITHOUT(folder / "calib_cam_to_cam.txt");
  for (const KittiPair which : {KittiPair::kGrey, KittiPair::kColour}) {
    const RigDescription rig = read_kitti_raw_rig(folder, which);
    const KittiCalibration calibration = read_kitti_raw_calibration(folder, which);
    const auto pair = std::get<PinholePair>(images(rig).model);
    EXPECT_NEAR(pair.focal_px, 721.54, 5e-3);
    EXPECT_NEAR(pair.baseline_m, which == KittiPair::kGrey ? 0.5372 : 0.5327, 5e-5);
    EXPECT_EQ(pair.focal_px, calibration.pair.focal_px);
    EXPECT_EQ(pair.baseline_m, calibration.pair.baseline_m);
    EXPECT_EQ(pair.principal_u_px, calibration.pair.principal_u_px);
    EXPECT_EQ(pair.disparity_offset_px, calibration.pair.disparity_offset_px);
    expect_matrix(rig.pairs.at(0).T_body_camera.matrix(), calibration.T_body_right().matrix(), 0.0);
    EXPECT_EQ(images(rig).size_px, cv::Size(1242, 375));
  }
}

TEST(KittiRigSystem, TheRecordedSequenceIsTheColourPairOfItsDay) {
  const auto file = recorded_data() / "kitti_tracking_0003/calib_0003.txt";
  const auto day = recorded_data() / "kitti_raw/2011_09_26";
  SKYHALO_SKIP_WITHOUT(file);
  SKYHALO_SKIP_WITHOUT(day / "calib_cam_to_cam.txt");
  const RigDescription tracking = read_kitti_tracking_rig(file, cv::Size(1242, 375));
  const RigDescription raw = read_kitti_raw_rig(day, KittiPair::kColour);
  expect_matrix(
      tracking.pairs.at(0).T_body_camera.matrix(), raw.pairs.at(0).T_body_camera.matrix(), 1e-6);
  EXPECT_NEAR(std::get<PinholePair>(images(tracking).model).baseline_m, 0.5327, 5e-5);
}

TEST(KittiRigTest, AFolderThatCannotBeReadIsNamed) {
  const TempFolder folder;
  const auto path = folder.path() / std::string(5000, 'x');
  EXPECT_THAT(message_of([&] { (void)read_kitti_raw_rig(path, KittiPair::kGrey); }),
              HasSubstr(path.string()));
}

}  // namespace
}  // namespace skyhalo
