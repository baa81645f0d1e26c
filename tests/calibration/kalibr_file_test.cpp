#include "skyhalo/calibration/kalibr_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::BadChange;
using ::testing::ElementsAre;
using testing::expect_matrix;
using testing::expect_refused;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::replaced;
using ::testing::SizeIs;
using testing::TempFolder;

/// Two cameras 0.25 m apart, side by side.
const std::string kPinholes =
    "cam0:\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [-0.1, 0.02, 0.001, -0.002]\n"
    "  distortion_model: radtan\n"
    "  intrinsics: [400.0, 401.0, 320.0, 240.0]\n"
    "  resolution: [640, 480]\n"
    "  rostopic: /cam0/image_raw\n"
    "cam1:\n"
    "  T_cn_cnm1:\n"
    "  - [1.0, 0.0, 0.0, -0.25]\n"
    "  - [0.0, 1.0, 0.0, 0.0]\n"
    "  - [0.0, 0.0, 1.0, 0.0]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]\n"
    "  distortion_model: equidistant\n"
    "  intrinsics: [402.0, 403.0, 321.0, 241.0]\n"
    "  resolution: [648, 488]\n";

ImportedCameras read(const std::string& text) {
  const TempFolder folder;
  return read_kalibr(folder.write("camchain.yaml", text));
}

void read_file(const std::filesystem::path& file) {
  (void)read_kalibr(file);
}

TEST(KalibrFileTest, PinholeCamerasAreReadOff) {
  const ImportedCameras imported = read(kPinholes);
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_FALSE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  const ImportedCamera& left = imported.cameras[0];
  EXPECT_EQ(left.name, "cam0");
  EXPECT_EQ(left.camera.size_px, cv::Size(640, 480));
  EXPECT_EQ(intrinsics(left.camera.lens).fy_px, 401.0);
  EXPECT_THAT(std::get<RadialTangentialLens>(left.camera.lens).distortion(),
              ElementsAre(-0.1, 0.02, 0.001, -0.002, 0.0, 0.0, 0.0, 0.0));
  const ImportedCamera& right = imported.cameras[1];
  EXPECT_EQ(right.camera.size_px, cv::Size(648, 488));
  EXPECT_EQ(intrinsics(right.camera.lens).cx_px, 321.0);
  EXPECT_THAT(std::get<KannalaBrandtLens>(right.camera.lens).distortion(),
              ElementsAre(0.01, 0.02, 0.03, 0.04));
}

TEST(KalibrFileTest, TheChainTakesPointsOfTheCameraBeforeToThisOne) {
  // cam0's origin is at x = -0.25 of cam1, so cam1 is at x = 0.25 of cam0; a third one is 0.5 m
  // below it, turned by a quarter about z.
  const std::string third =
      "cam2:\n"
      "  T_cn_cnm1: [[0, -1, 0, 0.5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n"
      "  camera_model: pinhole\n"
      "  distortion_coeffs: []\n"
      "  distortion_model: none\n"
      "  intrinsics: [402.0, 403.0, 321.0, 241.0]\n"
      "  resolution: [648, 488]\n";
  const ImportedCameras imported = read(kPinholes + third);
  ASSERT_THAT(imported.cameras, SizeIs(3));
  expect_matrix(imported.cameras[0].T_reference_camera.matrix(), Eigen::Matrix4d::Identity());
  expect_matrix(imported.cameras[1].T_reference_camera.translation(), Eigen::Vector3d(0.25, 0, 0));
  // In cam1 the third one's origin is R' (0 - t) = (0, 0.5, 0).
  expect_matrix(imported.cameras[2].T_reference_camera.translation(),
                Eigen::Vector3d(0.25, 0.5, 0));
}

std::string sphere_camera(const std::string& model, const std::string& intrinsics) {
  return "cam0:\n  camera_model: " + model + "\n  intrinsics: " + intrinsics +
         "\n  distortion_model: none\n  distortion_coeffs: []\n  resolution: [640, 480]\n";
}

TEST(KalibrFileTest, TheSphereLensesHaveTheirShapeInFront) {
  const ImportedCameras ds = read(sphere_camera("ds", "[-0.25, 0.6, 350, 351, 320, 240]"));
  const auto& double_sphere = std::get<DoubleSphereLens>(ds.cameras[0].camera.lens);
  EXPECT_EQ(double_sphere.shape().xi, -0.25);
  EXPECT_EQ(double_sphere.shape().alpha, 0.6);
  EXPECT_EQ(double_sphere.intrinsics().fy_px, 351.0);
  const ImportedCameras eucm = read(sphere_camera("eucm", "[0.6, 1.1, 350, 351, 320, 240]"));
  const auto& unified = std::get<ExtendedUnifiedLens>(eucm.cameras[0].camera.lens);
  EXPECT_EQ(unified.shape().alpha, 0.6);
  EXPECT_EQ(unified.shape().beta, 1.1);
  EXPECT_EQ(unified.intrinsics().cx_px, 320.0);
}

/// An IMU at (0.1, 0.2, 0.3) of cam0, x ahead (cam z), y left (cam -x), z up (cam -y).
const std::string kImuToFirst = "[[0, -1, 0, 0.1], [0, 0, -1, 0.2], [1, 0, 0, 0.3], [0, 0, 0, 1]]";
/// The same from cam1, a quarter of a metre to the right.
const std::string kImuToSecond =
    "[[0, -1, 0, -0.15], [0, 0, -1, 0.2], [1, 0, 0, 0.3], [0, 0, 0, 1]]";

std::string with_imu(const std::string& key, const std::string& first, const std::string& second) {
  return replaced(replaced(kPinholes, "cam0:\n", "cam0:\n  " + key + ": " + first + "\n"),
                  "cam1:\n",
                  "cam1:\n  " + key + ": " + second + "\n");
}

TEST(KalibrFileTest, WithTheImuItIsTheReference) {
  const ImportedCameras imported = read(with_imu("T_cam_imu", kImuToFirst, kImuToSecond));
  EXPECT_TRUE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  // cam0's origin in the IMU: -R' t = (-0.3, 0.1, 0.2); cam1's is 0.25 m to the right, along -y.
  expect_matrix(imported.cameras[0].T_reference_camera.translation(),
                Eigen::Vector3d(-0.3, 0.1, 0.2));
  expect_matrix(imported.cameras[1].T_reference_camera.translation(),
                Eigen::Vector3d(-0.3, -0.15, 0.2));
}

TEST(KalibrFileTest, OpenVinsGivesTheOtherDirectionAfterADirective) {
  const std::string first = "[[0, 0, 1, -0.3], [-1, 0, 0, 0.1], [0, -1, 0, 0.2], [0, 0, 0, 1]]";
  const std::string second = "[[0, 0, 1, -0.3], [-1, 0, 0, -0.15], [0, -1, 0, 0.2], [0, 0, 0, 1]]";
  const ImportedCameras imported =
      read("%YAML:1.0 # for OpenCV\n\n" + with_imu("T_imu_cam", first, second));
  EXPECT_TRUE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  expect_matrix(imported.cameras[1].T_reference_camera.translation(),
                Eigen::Vector3d(-0.3, -0.15, 0.2));
}

TEST(KalibrFileTest, AnInvertedChainIsNamed) {
  const std::string text = replaced(
      with_imu("T_cam_imu", kImuToFirst, kImuToSecond), "0.0, 0.0, -0.25]", "0.0, 0.0, 0.25]");
  const ImportedCameras imported = read(text);
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0],
              AllOf(HasSubstr("camchain.yaml:11: cam1.T_cn_cnm1"), HasSubstr("inverted")));
  EXPECT_TRUE(imported.reference_is_imu);
}

TEST(KalibrFileTest, AChainThatContradictsTheImuIsNamed) {
  const std::string text = replaced(
      with_imu("T_cam_imu", kImuToFirst, kImuToSecond), "0.0, 0.0, -0.25]", "0.0, 0.0, -0.35]");
  const ImportedCameras imported = read(text);
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], AllOf(HasSubstr("cam1.T_cn_cnm1"), HasSubstr("contradicts")));
}

TEST(KalibrFileTest, InvertedPosesToTheImuAreNamedTwice) {
  // T_imu_cam's numbers under the name of T_cam_imu.
  const ImportedCameras imported = read(with_imu("T_imu_cam", kImuToFirst, kImuToSecond));
  ASSERT_THAT(imported.warnings, SizeIs(2));
  EXPECT_THAT(imported.warnings[0],
              AllOf(HasSubstr("cam1.T_cn_cnm1: contradicts"), HasSubstr("look inverted")));
  EXPECT_THAT(imported.warnings[1], HasSubstr("T_imu_cam looks inverted"));
}

TEST(KalibrFileTest, AnImuOfOneCameraIsLeftOutWithAWarning) {
  const ImportedCameras imported =
      read(replaced(kPinholes, "cam0:\n", "cam0:\n  T_cam_imu: " + kImuToFirst + "\n"));
  EXPECT_FALSE(imported.reference_is_imu);
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], HasSubstr("the IMU is left out"));
  expect_matrix(imported.cameras[1].T_reference_camera.translation(), Eigen::Vector3d(0.25, 0, 0));
}

TEST(KalibrFileTest, WhatIsMissingIsNamed) {
  expect_refused(kPinholes,
                 "camchain.yaml",
                 {{"cam0:", "camera:", {"cam0: this key is missing"}},
                  {"cam1:", "cam2:", {"cam1: this key is missing"}},
                  {"  intrinsics: [400.0", "  intrinsic: [400.0", {"cam0.intrinsics", "missing"}},
                  {"camera_model", "model", {"cam0.camera_model: this key is missing"}},
                  {"distortion_model", "model", {"cam0.distortion_model: this key is missing"}},
                  {"distortion_coeffs", "D", {"cam0.distortion_coeffs: this key is missing"}},
                  {"resolution", "size", {"cam0.resolution: this key is missing"}},
                  {"T_cn_cnm1", "T", {"cam1.T_cn_cnm1: this key is missing", "T_cam_imu"}}},
                 read_file);
}

TEST(KalibrFileTest, AWrongCountIsNamed) {
  expect_refused(
      kPinholes,
      "camchain.yaml",
      {{", 240.0]", "]", {":5: cam0.intrinsics: expected 4 numbers, found 3"}},
       {", -0.002]", "]", {":3: cam0.distortion_coeffs: expected 4, 5 or 8 numbers, found 3"}},
       {", 0.04]", ", 0.04, 0]", {":15: cam1.distortion_coeffs: expected 4 numbers, found 5"}},
       {"[640, 480]", "[640]", {":6: cam0.resolution: expected width and height"}},
       {", -0.25]", "]", {":9: cam1.T_cn_cnm1: expected 16 numbers, found 15"}}},
      read_file);
  expect_refused(sphere_camera("ds", "[-0.25, 0.6, 350, 351, 320, 240]"),
                 "camchain.yaml",
                 {{"[-0.25, ", "[", {":3: cam0.intrinsics: expected 6 numbers, found 5"}},
                  {"none", "radtan", {"cam0.distortion_model: 'radtan'", "none"}},
                  {"0.6", "1.6", {"cam0.intrinsics: expected xi", "alpha"}},
                  {"350", "-350", {"cam0.intrinsics: "}}},
                 read_file);
}

TEST(KalibrFileTest, AWrongNumberIsNamed) {
  expect_refused(kPinholes,
                 "camchain.yaml",
                 {{"400.0", ".nan", {":5: cam0.intrinsics", ".nan"}},
                  {"400.0", "0", {":5: cam0.intrinsics: "}},
                  {"-0.1", "nan", {":3: cam0.distortion_coeffs", "nan"}},
                  {"-0.25", "abc", {"cam1.T_cn_cnm1", "abc"}},
                  {"[640, 480]", "[640, -480]", {":6: cam0.resolution"}},
                  {"[640, 480]", "[640, 16385]", {":6: cam0.resolution[1]", "1...16384"}},
                  {"  camera_model: pinhole",
                   "  resolution: [64, 48]\n  camera_model: pinhole",
                   {":2: cam0.resolution: is given twice"}},
                  {"[1.0, 0.0, 0.0, -0.25]",
                   "[2.0, 0.0, 0.0, -0.25]",
                   {"cam1.T_cn_cnm1: the rotation is not orthonormal"}}},
                 read_file);
}

TEST(KalibrFileTest, WhatIsNotSupportedIsNamedWithWhatIs) {
  expect_refused(
      kPinholes,
      "camchain.yaml",
      {{"camera_model: pinhole",
        "camera_model: omni",
        {":2: cam0.camera_model: 'omni' is not supported; supported are pinhole, ds and eucm"}},
       {"radtan",
        "fov",
        {":4: cam0.distortion_model: 'fov' is not supported; supported are radtan, equidistant"}}},
      read_file);
}

TEST(KalibrFileTest, AFileWithoutContentIsNamed) {
  testing::expect_no_content_refused("camchain.yaml", read_file);
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read_file(folder.write("a.yaml", "cam0: [1, 2\n")); }),
              HasSubstr("a.yaml:"));
  EXPECT_THAT(message_of([&] { read_file(folder.write("a.yaml", "cam0: 3\n")); }),
              HasSubstr("cam0"));
}

}  // namespace
}  // namespace skyhalo
