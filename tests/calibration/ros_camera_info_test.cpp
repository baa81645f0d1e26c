#include "skyhalo/calibration/ros_camera_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"
#include "support/calibration_texts.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::BadChange;
using ::testing::ElementsAre;
using testing::expect_matrix;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::replaced;
using testing::ros_text;
using ::testing::SizeIs;
using testing::TempFolder;

const std::string kLeft = ros_text("0.0");
const std::string kRight = ros_text("-100.0");  // -500 * 0.2 m

ImportedCameras read(const std::string& left, const std::string& right) {
  const TempFolder folder;
  return read_ros_camera_info(folder.write("left.yaml", left), folder.write("right.yaml", right));
}

Pose T_right_left(const ImportedCameras& imported) {
  return imported.cameras[1].T_reference_camera.inverse() * imported.cameras[0].T_reference_camera;
}

TEST(RosCameraInfoTest, TheCamerasAreReadOff) {
  const ImportedCameras imported = read(kLeft, kRight);
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_FALSE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  EXPECT_EQ(imported.cameras[0].name, "left");
  EXPECT_EQ(imported.cameras[1].name, "right");
  const RawCamera& camera = imported.cameras[0].camera;
  EXPECT_EQ(camera.size_px, cv::Size(640, 480));
  EXPECT_EQ(intrinsics(camera.lens).fx_px, 400.0);
  EXPECT_EQ(intrinsics(camera.lens).fy_px, 401.0);
  EXPECT_EQ(intrinsics(camera.lens).cx_px, 320.0);
  EXPECT_EQ(intrinsics(camera.lens).cy_px, 240.0);
  EXPECT_THAT(std::get<RadialTangentialLens>(camera.lens).distortion(),
              ElementsAre(-0.1, 0.02, 0.001, -0.002, 0.0, 0.0, 0.0, 0.0));
}

TEST(RosCameraInfoTest, TheBaselineIsInTheRightProjection) {
  expect_matrix(T_right_left(read(kLeft, kRight)).matrix(),
                make_pose(Eigen::Matrix3d::Identity(), {-0.2, 0, 0}).matrix());
}

TEST(RosCameraInfoTest, TheLeftProjectionMayBeShiftedToo) {
  // 50 / 500 = 0.1 to the left of the common frame, the right one 0.2 to its right.
  expect_matrix(T_right_left(read(ros_text("50.0"), kRight)).translation(),
                Eigen::Vector3d(-0.3, 0, 0));
}

TEST(RosCameraInfoTest, TheRectifyingRotationsAreUndone) {
  // Left: a quarter turn about z, (x, y, z) to (-y, x, z). Right: about x, (x, y, z) to (x, -z, y).
  // The left camera's (1, 2, 3) is (-2, 1, 3) rectified, (-2.2, 1, 3) in the right rectified frame,
  // and (-2.2, 3, -1) in the right camera.
  const std::string identity = "[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]";
  const ImportedCameras imported = read(replaced(kLeft, identity, "[0, -1, 0, 1, 0, 0, 0, 0, 1]"),
                                        replaced(kRight, identity, "[1, 0, 0, 0, 0, -1, 0, 1, 0]"));
  expect_matrix(T_right_left(imported) * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-2.2, 3, -1));
}

TEST(RosCameraInfoTest, TheOtherLensModelsAreRead) {
  const std::string rational =
      replaced(replaced(replaced(kLeft, "plumb_bob", "rational_polynomial"), "cols: 5", "cols: 8"),
               "-0.002, 0.0]",
               "-0.002, 0.01, 0.02, 0.03, 0.04]");
  const std::string fisheye =
      replaced(replaced(replaced(kRight, "plumb_bob", "equidistant"), "cols: 5", "cols: 4"),
               "-0.002, 0.0]",
               "-0.002]");
  const ImportedCameras imported = read(rational, fisheye);
  EXPECT_THAT(std::get<RadialTangentialLens>(imported.cameras[0].camera.lens).distortion(),
              ElementsAre(-0.1, 0.02, 0.001, -0.002, 0.01, 0.02, 0.03, 0.04));
  EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[1].camera.lens).distortion(),
              ElementsAre(-0.1, 0.02, 0.001, -0.002));
}

TEST(RosCameraInfoTest, TwoFilesThatSayNothingOfEachOtherAreRefused) {
  EXPECT_THAT(message_of([] { (void)read(kLeft, kLeft); }),
              AllOf(HasSubstr("right.yaml:17: projection_matrix"), HasSubstr("left.yaml")));
}

TEST(RosCameraInfoTest, WhatIsWrongIsNamed) {
  const std::vector<BadChange> changes = {
      {"image_width", "width", {"image_width: this key is missing"}},
      {"camera_matrix", "K", {"camera_matrix: this key is missing"}},
      {"distortion_model", "model", {"distortion_model: this key is missing"}},
      {"distortion_coefficients", "D", {"distortion_coefficients: this key is missing"}},
      {"rectification_matrix", "R", {"rectification_matrix: this key is missing"}},
      {"projection_matrix", "P", {"projection_matrix: this key is missing"}},
      {"image_width: 640", "image_width: 0", {":1: image_width"}},
      {"image_height: 480", "image_height: 48.5", {":2: image_height"}},
      {"image_width: 640", "image_width: 16385", {":1: image_width: expected", "1...16384"}},
      {"image_height: 480", "image_height: 0", {":2: image_height: expected", "1...16384"}},
      {"image_width", "binning_x: 2\nimage_width", {":1: binning_x: binned images", "found 2"}},
      {"image_width", "binning_y: 4\nimage_width", {":1: binning_y: binned images", "found 4"}},
      {"image_width", "binning_y: -1\nimage_width", {":1: binning_y: binned images"}},
      {"image_width", "roi: {x_offset: 8}\nimage_width", {":1: roi.x_offset: a part", "found 8"}},
      {"image_width", "roi: {y_offset: 8}\nimage_width", {":1: roi.y_offset: a part", "found 8"}},
      {"image_width", "roi: {width: 639}\nimage_width", {":1: roi.width: a part", "found 639"}},
      {"image_width", "roi: {height: 640}\nimage_width", {":1: roi.height: a part", "found 640"}},
      {"image_width", "image_height: 480\nimage_width", {"image_height: is given twice"}},
      {"240.0, 0.0,", "240.0,", {"camera_matrix.data: expected 3 x 3 numbers, found 8"}},
      {"-0.002, 0.0]", "-0.002]", {"distortion_coefficients.data: expected 1 x 5 numbers"}},
      {"  cols: 5\n  data: [", "  cols: 6\n  data: [0.0, ", {"expected 4 or 5 numbers", "found 6"}},
      {"plumb_bob", "equidistant", {"distortion_coefficients: expected 4 numbers", "found 5"}},
      {"plumb_bob", "fov", {":8: distortion_model: 'fov'", "plumb_bob", "equidistant"}},
      {"400.0", ".nan", {"camera_matrix", ".nan"}},
      {"400.0", "-400.0", {":4: camera_matrix: "}},
      {"[400.0, 0.0", "[400.0, 1.5", {":4: camera_matrix: expected fx 0 cx"}},
      {"-0.1", "nan", {"distortion_coefficients", "nan"}},
      {"[1.0, 0.0", "[1.5, 0.0", {":13: rectification_matrix: the rotation"}},
      {"[500.0", "[0.0", {":17: projection_matrix"}},
      {"322.0, -100.0", "322.0, nan", {"projection_matrix", "nan"}}};
  const TempFolder folder;
  const auto left = folder.write("left.yaml", kLeft);
  testing::expect_refused(kRight, "right.yaml", changes, [&](const std::filesystem::path& right) {
    (void)read_ros_camera_info(left, right);
  });
  testing::expect_no_content_refused("right.yaml", [&](const std::filesystem::path& right) {
    (void)read_ros_camera_info(left, right);
  });
}

TEST(RosCameraInfoTest, WholeImagesMayBeSaidToBeWhole) {
  for (const std::string whole :
       {"binning_x: 0\nbinning_y: 0\n"
        "roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}\n",
        "binning_x: 1\nbinning_y: 1\n"
        "roi: {x_offset: 0, y_offset: 0, height: 480, width: 640, do_rectify: true}\n"}) {
    SCOPED_TRACE(whole);
    EXPECT_EQ(read(kLeft + whole, kRight + whole).cameras.at(0).camera.size_px, cv::Size(640, 480));
  }
}

}  // namespace
}  // namespace skyhalo
