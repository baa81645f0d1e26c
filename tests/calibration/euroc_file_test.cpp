#include "skyhalo/calibration/euroc_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::expect_matrix;
using testing::expect_refused;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::recorded_data;
using testing::replaced;
using ::testing::SizeIs;
using testing::TempFolder;

/// A camera at (x, y, 0.3) of a body with x right, y down, z ahead as its own.
std::string sensor(const std::string& x, const std::string& y) {
  return "# General sensor definitions.\n"
         "sensor_type: camera\n"
         "T_BS:\n"
         "  cols: 4\n"
         "  rows: 4\n"
         "  data: [1.0, 0.0, 0.0, " +
         x + ",\n         0.0, 1.0, 0.0, " + y +
         ",\n         0.0, 0.0, 1.0, 0.3,\n         0.0, 0.0, 0.0, 1.0]\n"
         "rate_hz: 20\n"
         "resolution: [752, 480]\n"
         "camera_model: pinhole\n"
         "intrinsics: [458.0, 457.0, 367.0, 248.0] #fu, fv, cu, cv\n"
         "distortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.28, 0.07, 0.0002, 1.76e-05]\n";
}

const std::string kSensor = sensor("0.1", "0.2");

void read_file(const std::filesystem::path& file) {
  (void)read_euroc({file});
}

TEST(EurocFileTest, ACameraIsReadOff) {
  const TempFolder folder;
  const ImportedCameras imported = read_euroc({folder.write("left.yaml", kSensor)});
  ASSERT_THAT(imported.cameras, SizeIs(1));
  EXPECT_TRUE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  const ImportedCamera& camera = imported.cameras[0];
  EXPECT_EQ(camera.name, "left");
  EXPECT_EQ(camera.camera.size_px, cv::Size(752, 480));
  EXPECT_EQ(intrinsics(camera.camera.lens).fx_px, 458.0);
  EXPECT_THAT(std::get<RadialTangentialLens>(camera.camera.lens).distortion(),
              ElementsAre(-0.28, 0.07, 0.0002, 1.76e-05, 0.0, 0.0, 0.0, 0.0));
  expect_matrix(camera.T_reference_camera.translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(EurocFileTest, MoreCoefficientsAndTheFisheyeAreRead) {
  const TempFolder folder;
  const std::string eight = replaced(kSensor, "1.76e-05]", "1.76e-05, 0.01, 0.02, 0.03, 0.04]");
  const std::string fisheye = replaced(kSensor, "radial-tangential", "equidistant");
  const ImportedCameras imported =
      read_euroc({folder.write("a.yaml", eight), folder.write("b.yaml", "%YAML:1.0\n" + fisheye)});
  EXPECT_THAT(std::get<RadialTangentialLens>(imported.cameras[0].camera.lens).distortion(),
              ElementsAre(-0.28, 0.07, 0.0002, 1.76e-05, 0.01, 0.02, 0.03, 0.04));
  EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[1].camera.lens).distortion(),
              ElementsAre(-0.28, 0.07, 0.0002, 1.76e-05));
}

TEST(EurocFileTest, AFolderStandsForItsCameras) {
  const TempFolder folder;
  EXPECT_FALSE(is_euroc_folder(folder.path()));
  EXPECT_THAT(message_of([&] { (void)read_euroc({folder.path()}); }),
              AllOf(HasSubstr(folder.path().string()), HasSubstr("cam0/sensor.yaml")));
  (void)folder.write("run/mav0/cam0/sensor.yaml", sensor("-0.1", "0"));
  (void)folder.write("run/mav0/cam1/sensor.yaml", sensor("0.1", "0"));
  for (const auto& path : {folder.path() / "run", folder.path() / "run/mav0"}) {
    EXPECT_TRUE(is_euroc_folder(path));
    const ImportedCameras imported = read_euroc({path});
    ASSERT_THAT(imported.cameras, SizeIs(2));
    EXPECT_EQ(imported.cameras[0].name, "cam0");
    EXPECT_EQ(imported.cameras[1].name, "cam1");
    expect_matrix(imported.cameras[1].T_reference_camera.translation(),
                  Eigen::Vector3d(0.1, 0, 0.3));
  }
}

TEST(EurocFileTest, InvertedPosesAreNamed) {
  // The body's x is the camera's z and so on; written is the body in the camera.
  const auto inverted = [](const std::string& x) {
    return replaced(kSensor,
                    "[1.0, 0.0, 0.0, 0.1,\n         0.0, 1.0, 0.0, 0.2,\n         0.0, 0.0, 1.0,",
                    "[0.0, -1.0, 0.0, " + x + ", 0.0, 0.0, -1.0, 0.2, 1.0, 0.0, 0.0,");
  };
  const TempFolder folder;
  const ImportedCameras imported = read_euroc(
      {folder.write("l.yaml", inverted("0.1")), folder.write("r.yaml", inverted("-0.1"))});
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], HasSubstr("T_BS looks inverted"));
}

TEST(EurocFileTest, WhatIsWrongIsNamed) {
  expect_refused(
      kSensor,
      "sensor.yaml",
      {{"T_BS", "T_SB", {"T_BS: this key is missing"}},
       {"intrinsics", "K", {"intrinsics: this key is missing"}},
       {"distortion_model", "model", {"distortion_model: this key is missing"}},
       {"distortion_coefficients", "D", {"distortion_coefficients: this key is missing"}},
       {"resolution", "size", {"resolution: this key is missing"}},
       {"0.0, 1.0]", "1.0]", {"T_BS.data: expected 4 x 4 numbers, found 15"}},
       {", 248.0]", "]", {":13: intrinsics: expected 4 numbers, found 3"}},
       {", 1.76e-05]", "]", {":15: distortion_coefficients: expected 4, 5 or 8 numbers, found 3"}},
       {"752, ", "", {":11: resolution: expected width and height"}},
       {"752, ", "16385, ", {":11: resolution[0]: expected", "1...16384"}},
       {"intrinsics", "T_BS: 1\nintrinsics", {":3: T_BS: is given twice"}},
       {"458.0", ".nan", {":13: intrinsics", ".nan"}},
       {"458.0", "-458.0", {":13: intrinsics: "}},
       {"0.2,", "nan,", {"T_BS.data", "nan"}},
       {"[1.0", "[1.1", {":3: T_BS: the rotation is not orthonormal"}},
       {"radial-tangential", "fov", {":14: distortion_model: 'fov'", "equidistant"}},
       {"pinhole", "omni", {":12: camera_model: 'omni'", "pinhole"}}},
      read_file);
  testing::expect_no_content_refused("sensor.yaml", read_file);
}

TEST(EurocFileSystem, TheRecordedFlightHasItsBaseline) {
  const auto folder = recorded_data() / "euroc_V1_01_flight";
  SKYHALO_SKIP_WITHOUT(folder);
  const ImportedCameras imported = read_euroc({folder});
  EXPECT_THAT(imported.warnings, IsEmpty());
  const RigDescription rig = assemble_rig(imported, {}, "euroc");
  const RawPair& pair = std::get<RawPairDescription>(rig.pairs.at(0).images).cameras;
  EXPECT_NEAR(pair.T_right_left.translation().x(), -0.110, 5e-4);
  EXPECT_NEAR(pair.T_right_left.translation().norm(), 0.110, 5e-4);
  EXPECT_GT(rig.pairs[0].T_body_camera.linear()(0, 2), 0.99);   // looks forward
  EXPECT_LT(rig.pairs[0].T_body_camera.linear()(2, 1), -0.99);  // and stands upright
}

TEST(EurocFileSystem, TheRecordedFisheyesHaveTheirBaseline) {
  const auto folder = recorded_data() / "fisheye_mynteye";
  SKYHALO_SKIP_WITHOUT(folder);
  const ImportedCameras imported =
      read_euroc({folder / "left_sensor_fisheye.yaml", folder / "right_sensor_fisheye.yaml"});
  EXPECT_THAT(imported.warnings, IsEmpty());
  const RigDescription rig = assemble_rig(imported, {}, "mynteye");
  const RawPair& pair = std::get<RawPairDescription>(rig.pairs.at(0).images).cameras;
  EXPECT_NEAR(pair.T_right_left.translation().x(), -0.1203, 5e-5);
  EXPECT_TRUE(std::holds_alternative<KannalaBrandtLens>(pair.left.lens));
}

TEST(EurocFileTest, AFolderThatCannotBeReadIsNamed) {
  const TempFolder folder;
  const auto path = folder.path() / std::string(5000, 'x');
  EXPECT_THAT(message_of([&] { (void)is_euroc_folder(path); }), HasSubstr(path.string()));
  EXPECT_THAT(message_of([&] { (void)read_euroc({path}); }), HasSubstr(path.string()));
}

}  // namespace
}  // namespace skyhalo
