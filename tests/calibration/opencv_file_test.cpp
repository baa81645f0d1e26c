#include "skyhalo/calibration/opencv_file.hpp"

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

std::string matrix(const std::string& key, int rows, int cols, const std::string& data) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(cols) + "\n   dt: d\n   data: [ " + data + " ]\n";
}

const std::string kHead = "%YAML:1.0\n---\n";
const std::string kIntrinsics = matrix("M1", 3, 3, "400., 0., 320., 0., 401., 240., 0., 0., 1.") +
                                matrix("D1", 1, 5, "-0.1, 0.02, 0.001, -0.002, 0.003") +
                                matrix("M2", 3, 3, "402., 0., 321., 0., 403., 241., 0., 0., 1.") +
                                matrix("D2", 1, 4, "-0.2, 0.03, 0.002, -0.001");
const std::string kExtrinsics = matrix("R", 3, 3, "0., -1., 0., 1., 0., 0., 0., 0., 1.") +
                                matrix("T", 3, 1, "-0.2, 0.01, 0.02");
const std::string kSize = "image_size: [ 640, 480 ]\n";
const std::string kWhole = kHead + kIntrinsics + kExtrinsics + kSize;

ImportedCameras read(const std::string& text) {
  const TempFolder folder;
  return read_opencv_stereo({folder.write("stereo.yml", text)}, std::nullopt);
}

void read_file(const std::filesystem::path& file) {
  (void)read_opencv_stereo({file}, std::nullopt);
}

TEST(OpencvFileTest, TheCamerasAreReadOff) {
  const ImportedCameras imported = read(kWhole);
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_FALSE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, SizeIs(1));  // of the right camera's four coefficients
  EXPECT_EQ(imported.cameras[0].name, "left");
  EXPECT_EQ(imported.cameras[0].camera.size_px, cv::Size(640, 480));
  const auto& left = std::get<RadialTangentialLens>(imported.cameras[0].camera.lens);
  EXPECT_EQ(left.intrinsics().fx_px, 400.0);
  EXPECT_EQ(left.intrinsics().fy_px, 401.0);
  EXPECT_EQ(left.intrinsics().cx_px, 320.0);
  EXPECT_EQ(left.intrinsics().cy_px, 240.0);
  EXPECT_THAT(left.distortion(), ElementsAre(-0.1, 0.02, 0.001, -0.002, 0.003, 0, 0, 0));
  const auto& right = std::get<RadialTangentialLens>(imported.cameras[1].camera.lens);
  EXPECT_THAT(right.distortion(), ElementsAre(-0.2, 0.03, 0.002, -0.001, 0, 0, 0, 0));
}

TEST(OpencvFileTest, RAndTTakeTheLeftCameraToTheRight) {
  const ImportedCameras imported = read(kWhole);
  const Pose T_right_left =
      imported.cameras[1].T_reference_camera.inverse() * imported.cameras[0].T_reference_camera;
  // R (1, 2, 3) + T = (-2, 1, 3) + (-0.2, 0.01, 0.02).
  expect_matrix(T_right_left * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-2.2, 1.01, 3.02));
}

TEST(OpencvFileTest, IntrinsicsAndExtrinsicsMayBeTwoFiles) {
  const TempFolder folder;
  const ImportedCameras imported =
      read_opencv_stereo({folder.write("intrinsics.yml", kHead + kIntrinsics),
                          folder.write("extrinsics.yml", kHead + kExtrinsics)},
                         cv::Size(800, 600));
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_EQ(imported.cameras[1].camera.size_px, cv::Size(800, 600));
}

TEST(OpencvFileTest, OtherSpellingsAreKnown) {
  for (const auto& [left, right] : std::vector<std::pair<std::string, std::string>>{
           {"K1", "K2"},
           {"cameraMatrix1", "cameraMatrix2"},
           {"cameraMatrixL", "cameraMatrixR"},
           {"camera_matrix_left", "camera_matrix_right"},
           {"left_camera_matrix", "right_camera_matrix"}}) {
    SCOPED_TRACE(left);
    std::string text = replaced(replaced(kWhole, "M1", left), "M2", right);
    text = replaced(replaced(text, "D1", "distCoeffs1"), "D2", "distCoeffs2");
    EXPECT_EQ(intrinsics(read(text).cameras[1].camera.lens).fx_px, 402.0);
  }
  for (const std::string size :
       {"imageSize: [ 640, 480 ]\n", "image_width: 640\nimage_height: 480\n"}) {
    EXPECT_EQ(read(replaced(kWhole, kSize, size)).cameras[0].camera.size_px, cv::Size(640, 480));
  }
}

TEST(OpencvFileTest, TheFisheyeIsOneOnlyWhenAKeySaysSo) {
  const std::string four = replaced(replaced(kWhole, ", 0.003 ]", " ]"), "cols: 5", "cols: 4");
  EXPECT_TRUE(std::holds_alternative<RadialTangentialLens>(read(four).cameras[0].camera.lens));
  for (const std::string key : {"distortion_model: equidistant\n",
                                "distortion_model: fisheye\n",
                                "camera_model: fisheye\n",
                                "fisheye_model: 1\n"}) {
    SCOPED_TRACE(key);
    const ImportedCameras imported = read(four + key);
    EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[0].camera.lens).distortion(),
                ElementsAre(-0.1, 0.02, 0.001, -0.002));
  }
  EXPECT_TRUE(std::holds_alternative<RadialTangentialLens>(
      read(four + "fisheye_model: 0\n").cameras[0].camera.lens));
}

TEST(OpencvFileTest, WithoutASizeOneIsAskedFor) {
  expect_refused(kWhole,
                 "stereo.yml",
                 {{"image_size",
                   "size",
                   {"image_size: this key is missing", "the size of the images must be given"}},
                  {"[ 640, 480 ]", "[ 640 ]", {"image_size: expected 2 numbers, found 1"}},
                  {"[ 640, 480 ]", "[ 640, 0 ]", {"image_size: expected a whole number"}},
                  {"[ 640, 480 ]", "[ 640, 48.5 ]", {"image_size: expected a whole number"}},
                  {"[ 640, 480 ]", "[ 16385, 480 ]", {"image_size: expected", "1...16384"}},
                  {"image_size: [ 640, 480 ]",
                   "image_width: 640\nimage_height: 16385",
                   {"image_height: expected", "1...16384"}}},
                 read_file);
}

TEST(OpencvFileTest, WhatIsWrongIsNamed) {
  const std::vector<BadChange> changes = {
      {"M1:", "N1:", {"M1 (nor K1,", "missing"}},
      {"M2:", "N2:", {"M2 (nor K2,", "missing"}},
      {"D1:", "N1:", {"D1 (nor distCoeffs1,", "missing"}},
      {"D2:", "N2:", {"D2 (nor distCoeffs2,", "missing"}},
      {"R:", "N:", {"R: this key is missing"}},
      {"T:", "N:", {"T: this key is missing"}},
      {"0., 0., 1. ]", "0., 1. ]", {"M1: expected rows x cols numbers, found 8"}},
      {"400.", ".Nan", {"M1: expected finite numbers"}},
      {"400.", "-400.", {"M1: "}},
      {"400., 0.", "400., 1.", {"M1: expected fx 0 cx"}},
      {"[ -0.1", "[ .Inf", {"D1: expected finite numbers"}},
      {"[ 0., -1.", "[ 0., -1.1", {"R: the rotation is not orthonormal"}},
      {"-0.2, 0.01", "foo, 0.01", {"T: expected finite numbers, found 'foo'"}},
      {"image_size", "xi1: 1.2\nimage_size", {"xi1: the omnidirectional model is not supported"}},
      {"image_size",
       "distortion_model: fov\nimage_size",
       {"distortion_model: 'fov' is not supported", "equidistant"}}};
  expect_refused(kWhole, "stereo.yml", changes, read_file);
  testing::expect_no_content_refused("stereo.yml", read_file);
}

TEST(OpencvFileTest, AWrongCountOfCoefficientsIsNamed) {
  const auto with = [](int count, const std::string& data) {
    return kHead + replaced(kIntrinsics + kExtrinsics + kSize,
                            matrix("D1", 1, 5, "-0.1, 0.02, 0.001, -0.002, 0.003"),
                            matrix("D1", 1, count, data));
  };
  EXPECT_THAT(message_of([&] { (void)read(with(3, "0.1, 0.2, 0.3")); }),
              HasSubstr("stereo.yml: D1: expected 4, 5 or 8 numbers, found 3"));
  const std::string eight = "0.1, 0.02, 0.003, 0.004, 0.05, 0.06, 0.07, 0.08";
  EXPECT_THAT(std::get<RadialTangentialLens>(
                  read(with(12, eight + ", 0., 0., 0., 0.")).cameras[0].camera.lens)
                  .distortion(),
              ElementsAre(0.1, 0.02, 0.003, 0.004, 0.05, 0.06, 0.07, 0.08));
  EXPECT_THAT(message_of([&] { (void)read(with(14, eight + ", 0., 0., 0., 0., 0.01, 0.")); }),
              AllOf(HasSubstr("stereo.yml: D1:"), HasSubstr("tilted sensor"), HasSubstr("14")));
  // A fisheye has exactly four.
  EXPECT_THAT(message_of([&] { (void)read(kWhole + "distortion_model: fisheye\n"); }),
              HasSubstr("D1: expected 4 numbers, found 5"));
}

TEST(OpencvFileTest, TheNamesOfTheCameraMatricesComeInPairs) {
  EXPECT_EQ(opencv_camera_matrix_keys(0).size(), opencv_camera_matrix_keys(1).size());
  EXPECT_EQ(opencv_camera_matrix_keys(0).front(), "M1");
  EXPECT_EQ(opencv_camera_matrix_keys(1).front(), "M2");
}

/// Both cameras with four coefficients.
std::string four_each() {
  return replaced(replaced(kWhole, ", 0.003 ]", " ]"), "cols: 5", "cols: 4");
}

TEST(OpencvFileTest, FourCoefficientsOfAnUnnamedModelAreWarnedOf) {
  const ImportedCameras imported = read(four_each());
  ASSERT_THAT(imported.warnings, SizeIs(2));
  EXPECT_THAT(imported.warnings[0],
              HasSubstr("stereo.yml: D1: 4 numbers and no word of the model: taken for "
                        "radial-tangential; cv::fisheye writes 4 too"));
  EXPECT_THAT(imported.warnings[1], HasSubstr("stereo.yml: D2: 4 numbers"));
  EXPECT_THAT(read(four_each() + "camera_model: pinhole\n").warnings, SizeIs(2));
  for (const std::string named : {"distortion_model: plumb_bob\n",
                                  "distortion_model: fisheye\n",
                                  "fisheye_model: 1\n",
                                  "fisheye_model: 0\n"}) {
    SCOPED_TRACE(named);
    EXPECT_THAT(read(four_each() + named).warnings, IsEmpty());
  }
}

ImportedCameras read_fisheye(const std::string& text) {
  const TempFolder folder;
  return read_opencv_stereo({folder.write("stereo.yml", text)}, std::nullopt, true);
}

TEST(OpencvFileTest, TheFisheyeMayBeAskedFor) {
  for (const std::string model : {"", "camera_model: pinhole\n", "fisheye_model: 1\n"}) {
    SCOPED_TRACE(model);
    const ImportedCameras imported = read_fisheye(four_each() + model);
    EXPECT_THAT(imported.warnings, IsEmpty());
    EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[0].camera.lens).distortion(),
                ElementsAre(-0.1, 0.02, 0.001, -0.002));
    EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[1].camera.lens).distortion(),
                ElementsAre(-0.2, 0.03, 0.002, -0.001));
  }
  EXPECT_THAT(message_of([&] { (void)read_fisheye(kWhole); }),
              HasSubstr("stereo.yml: D1: expected 4 numbers, found 5"));
  for (const std::string other : {"distortion_model: plumb_bob\n", "fisheye_model: 0\n"}) {
    EXPECT_THAT(message_of([&] { (void)read_fisheye(four_each() + other); }),
                AllOf(HasSubstr("stereo.yml"), HasSubstr("not the fisheye model")));
  }
}

}  // namespace
}  // namespace skyhalo
