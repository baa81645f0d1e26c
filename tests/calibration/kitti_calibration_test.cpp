#include "skyhalo/calibration/kitti_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// The three files as text; the numbers are simple enough to be worked with by hand.
struct Files {
  std::string cameras =
      "calib_time: 09-Jan-2012 13:57:47\n"
      "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
      "P_rect_00: 256 0 160 0 0 256 48 0 0 0 1 0\n"
      "P_rect_01: 256 0 160 -128 0 256 48 0 0 0 1 0\n"
      "P_rect_02: 200 0 100 10 0 200 50 45 0 0 1 0.5\n"
      "P_rect_03: 200 0 110 -105 0 200 50 45 0 0 1 0.5\n";
  std::string laser = "calib_time: x\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0.25 -0.125 -0.25\n";
  std::string body = "calib_time: x\nR: 1 0 0 0 1 0 0 0 1\nT: -0.75 0 -0.5\n";
};

KittiCalibration read(const TempFolder& folder, const Files& files, KittiPair pair) {
  (void)folder.write("calib_cam_to_cam.txt", files.cameras);
  (void)folder.write("calib_velo_to_cam.txt", files.laser);
  (void)folder.write("calib_imu_to_velo.txt", files.body);
  return read_kitti_raw_calibration(folder.path(), pair);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_point(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-12) << actual.transpose();
}

TEST(KittiCalibrationTest, CamerasAreNumberedInPairs) {
  EXPECT_EQ(left_camera(KittiPair::kGrey), 0);
  EXPECT_EQ(left_camera(KittiPair::kColour), 2);
}

TEST(KittiCalibrationTest, TheGreyPairIsReadOffTheProjections) {
  const TempFolder folder;
  const KittiCalibration c = read(folder, {}, KittiPair::kGrey);
  EXPECT_EQ(c.pair.focal_px, 256.0);
  EXPECT_EQ(c.pair.principal_u_px, 160.0);
  EXPECT_EQ(c.pair.principal_v_px, 48.0);
  EXPECT_NEAR(c.pair.baseline_m, 0.5, 1e-12);  // 128 / 256
  EXPECT_NEAR(c.pair.disparity_offset_px, 0.0, 1e-12);
}

TEST(KittiCalibrationTest, TheRightCameraSitsWhereTheChainSays) {
  // Camera 00 is at (0.25, 0.25, -0.125) of the scanner: R c + T = 0. The right one is 0.5 m to its
  // right, along -y: (0.25, -0.25, -0.125). The scanner is at (0.75, 0, 0.5) of the body.
  const TempFolder folder;
  const KittiCalibration c = read(folder, {}, KittiPair::kGrey);
  expect_point(c.T_body_laser * Eigen::Vector3d::Zero(), {0.75, 0.0, 0.5});
  expect_point(c.T_reference_laser * Eigen::Vector3d(0.25, 0.25, -0.125), {0.0, 0.0, 0.0});
  const Pose T_body_right = c.T_body_right();
  expect_point(T_body_right * Eigen::Vector3d::Zero(), {1.0, -0.25, 0.375});
  // A metre ahead, to the right and down of the camera is (1, -1, -1) of the body.
  expect_point(T_body_right.linear() * Eigen::Vector3d::Ones(), {1.0, -1.0, -1.0});
}

TEST(KittiCalibrationTest, TheRectifyingRotationComesLast) {
  // The scanner's (1, 2, 3) is (-2, -3, 1) + T = (-1.75, -3.125, 0.75) in the raw camera; the
  // rectifying quarter turn takes (x, y, z) to (-y, x, z).
  const TempFolder folder;
  Files files;
  files.cameras =
      replaced(files.cameras, "R_rect_00: 1 0 0 0 1 0 0 0 1", "R_rect_00: 0 -1 0 1 0 0 0 0 1");
  const KittiCalibration c = read(folder, files, KittiPair::kGrey);
  expect_point(c.T_reference_laser * Eigen::Vector3d(1.0, 2.0, 3.0), {3.125, -1.75, 0.75});
}

TEST(KittiCalibrationTest, TheColourPairHasOffsetsAndPrincipalPointsOfItsOwn) {
  // t = K^-1 p: left ((10 - 100 * 0.5) / 200, (45 - 50 * 0.5) / 200, 0.5) = (-0.2, 0.1, 0.5), right
  // ((-105 - 110 * 0.5) / 200, 0.1, 0.5) = (-0.8, 0.1, 0.5).
  const TempFolder folder;
  const KittiCalibration c = read(folder, {}, KittiPair::kColour);
  expect_point(c.T_left_reference.translation(), {-0.2, 0.1, 0.5});
  expect_point(c.T_right_reference.translation(), {-0.8, 0.1, 0.5});
  EXPECT_NEAR(c.pair.baseline_m, 0.6, 1e-12);
  EXPECT_EQ(c.pair.principal_u_px, 110.0);
}

TEST(KittiCalibrationTest, ADisparityOfTheColourPairGivesThePointBack) {
  // (1, 0.5, 10) of the reference: left (0.8, 0.6, 10.5) at u = 200 * 0.8 / 10.5 + 100, right
  // (0.2, 0.6, 10.5) at u = 200 * 0.2 / 10.5 + 110, v = 200 * 0.6 / 10.5 + 50.
  const TempFolder folder;
  const KittiCalibration c = read(folder, {}, KittiPair::kColour);
  const double u_left_px = 160.0 / 10.5 + 100.0;
  const double u_right_px = 40.0 / 10.5 + 110.0;
  const double v_px = 120.0 / 10.5 + 50.0;
  expect_point(reproject(c.pair, u_right_px, v_px, u_left_px - u_right_px), {0.2, 0.6, 10.5});
  expect_point(c.T_right_reference * Eigen::Vector3d(1.0, 0.5, 10.0), {0.2, 0.6, 10.5});
}

/// A change to one of the files that must be refused with file, line and key.
struct Bad {
  std::string Files::*file = nullptr;
  std::string name;
  std::string from;
  std::string to;
  std::string expected_place;  ///< `:LINE:`, or empty for a key that is not there
  std::string key;
};

void expect_refused(const std::vector<Bad>& cases) {
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.name + ": " + bad.to);
    const TempFolder folder;
    Files files;
    files.*bad.file = replaced(files.*bad.file, bad.from, bad.to);
    const std::string place = (folder.path() / bad.name).string() + bad.expected_place;
    EXPECT_THAT(message_of([&] { (void)read(folder, files, KittiPair::kGrey); }),
                AllOf(HasSubstr(place), HasSubstr(bad.key)));
  }
}

TEST(KittiCalibrationTest, AMissingKeyIsRefused) {
  expect_refused({{&Files::cameras, "calib_cam_to_cam.txt", "P_rect_00", "Q", "", "P_rect_00"},
                  {&Files::cameras, "calib_cam_to_cam.txt", "P_rect_01", "Q", "", "P_rect_01"},
                  {&Files::cameras, "calib_cam_to_cam.txt", "R_rect_00", "Q", "", "R_rect_00"},
                  {&Files::laser, "calib_velo_to_cam.txt", "R:", "Q:", "", "R"},
                  {&Files::laser, "calib_velo_to_cam.txt", "T:", "Q:", "", "T"},
                  {&Files::body, "calib_imu_to_velo.txt", "R:", "Q:", "", "R"},
                  {&Files::body, "calib_imu_to_velo.txt", "T:", "Q:", "", "T"}});
}

TEST(KittiCalibrationTest, AMalformedKeyIsRefused) {
  expect_refused({{&Files::cameras,
                   "calib_cam_to_cam.txt",
                   "48 0 0 0 1 0\nP",
                   "48 0 0 0 1\nP",
                   ":3:",
                   "P_rect_00"},
                  {&Files::cameras, "calib_cam_to_cam.txt", "-128", "nan", ":4:", "P_rect_01"},
                  {&Files::laser, "calib_velo_to_cam.txt", "0.25 ", "inf ", ":3:", "T"},
                  {&Files::laser, "calib_velo_to_cam.txt", "1 0 0\n", "1 0\n", ":2:", "R"},
                  {&Files::body, "calib_imu_to_velo.txt", "-0.75", "-0.75m", ":3:", "T"}});
}

TEST(KittiCalibrationTest, ARotationThatIsNoneIsRefused) {
  const std::string identity = "1 0 0 0 1 0 0 0 1";
  expect_refused(
      {{&Files::cameras,
        "calib_cam_to_cam.txt",
        identity,
        "1 0 0 0 1 0 0 0 1.1",
        ":2:",
        "R_rect_00"},
       {&Files::body, "calib_imu_to_velo.txt", identity, "2 0 0 0 2 0 0 0 2", ":2:", "R"},
       {&Files::body, "calib_imu_to_velo.txt", identity, "0 0 0 0 0 0 0 0 0", ":2:", "R"},
       // A mirror is no rotation.
       {&Files::body, "calib_imu_to_velo.txt", identity, "1 0 0 0 1 0 0 0 -1", ":2:", "R"}});
}

TEST(KittiCalibrationTest, APairWithoutPositiveFocalLengthAndBaselineIsRefused) {
  const std::string name = "calib_cam_to_cam.txt";
  expect_refused(
      {{&Files::cameras,
        name,
        "P_rect_01: 256 0 160 -128",
        "P_rect_01: 256 0 160 128",
        ":4:",
        "P_rect_01"},
       {&Files::cameras,
        name,
        "P_rect_01: 256 0 160 -128",
        "P_rect_01: 256 0 160 0",
        ":4:",
        "P_rect_01"},
       {&Files::cameras, name, "256 0 160 0 0 256", "-256 0 160 0 0 -256", ":3:", "P_rect_00"},
       {&Files::cameras, name, "256 0 160 0 0 256", "0 0 160 0 0 0", ":3:", "P_rect_00"},
       // Rows that do not lie level make no rectified pair.
       {&Files::cameras, name, "160 -128 0 256 48", "160 -128 0 256 49", ":4:", "P_rect_01"},
       // Two focal lengths make no rectified pair.
       {&Files::cameras,
        name,
        "256 0 160 -128 0 256",
        "250 0 160 -128 0 250",
        ":4:",
        "P_rect_01"}});
}

TEST(KittiCalibrationTest, AMissingFileIsNamed) {
  for (const std::string name :
       {"calib_cam_to_cam.txt", "calib_velo_to_cam.txt", "calib_imu_to_velo.txt"}) {
    const TempFolder folder;
    (void)read(folder, {}, KittiPair::kGrey);
    std::filesystem::remove(folder.path() / name);
    EXPECT_THAT(
        message_of([&] { (void)read_kitti_raw_calibration(folder.path(), KittiPair::kGrey); }),
        HasSubstr((folder.path() / name).string()));
  }
}

}  // namespace
}  // namespace skyhalo
