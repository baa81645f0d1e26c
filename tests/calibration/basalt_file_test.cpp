#include "skyhalo/calibration/basalt_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::BadChange;
using ::testing::ElementsAre;
using testing::expect_matrix;
using testing::expect_refused;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::recorded_data;
using testing::replaced;
using ::testing::SizeIs;
using testing::TempFolder;

/// The left camera at (1, 2, 3), turned by a quarter about z (w = z = sqrt(0.5)); the right one
/// not.
const std::string kBasalt = R"({"value0": {
  "T_imu_cam": [
    {"px": 1.0, "py": 2.0, "pz": 3.0,
     "qx": 0, "qy": 0, "qz": 0.70710678118654757, "qw": 0.70710678118654757},
    {"px": 1.5, "py": 2.0, "pz": 3.0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
  "intrinsics": [
    {"camera_type": "ds",
     "intrinsics": {"fx": 350, "fy": 351, "cx": 366, "cy": 249, "xi": -0.25, "alpha": 0.6}},
    {"camera_type": "kb4",
     "intrinsics": {"fx": 380, "fy": 381, "cx": 376, "cy": 239,
                    "k1": 0.01, "k2": 0.02, "k3": 0.03, "k4": 0.04}}],
  "resolution": [[752, 480], [640, 400]],
  "cam_time_offset_ns": 0}})";

const std::string kVisnav = R"({"value0": {
  "cam.T_i_c": [
    {"px": 0.1, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1},
    {"px": 0.3, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
  "cam.intrinsics": [
    {"cam_type": "ds", "fx": 350, "fy": 351, "cx": 366, "cy": 249,
     "p1": -0.25, "p2": 0.6, "p3": 0.0, "p4": 0.0, "width": 752, "height": 480},
    {"cam_type": "eucm", "fx": 460, "fy": 461, "cx": 376, "cy": 239,
     "p1": 0.6, "p2": 1.1, "p3": 0.0, "p4": 0.0, "width": 640, "height": 400}]}})";

ImportedCameras read(const std::string& text) {
  const TempFolder folder;
  return read_basalt(folder.write("calib.json", text));
}

void read_file(const std::filesystem::path& file) {
  (void)read_basalt(file);
}

TEST(BasaltFileTest, BasaltsLayoutIsReadOff) {
  const ImportedCameras imported = read(kBasalt);
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_TRUE(imported.reference_is_imu);
  EXPECT_THAT(imported.warnings, IsEmpty());
  EXPECT_EQ(imported.cameras[0].name, "cam0");
  EXPECT_EQ(imported.cameras[0].camera.size_px, cv::Size(752, 480));
  const auto& ds = std::get<DoubleSphereLens>(imported.cameras[0].camera.lens);
  EXPECT_EQ(ds.intrinsics().fy_px, 351.0);
  EXPECT_EQ(ds.shape().xi, -0.25);
  EXPECT_EQ(ds.shape().alpha, 0.6);
  const auto& kb4 = std::get<KannalaBrandtLens>(imported.cameras[1].camera.lens);
  EXPECT_EQ(kb4.intrinsics().cx_px, 376.0);
  EXPECT_THAT(kb4.distortion(), ElementsAre(0.01, 0.02, 0.03, 0.04));
  // The camera's (1, 0, 0) is (0, 1, 0) of the IMU's axes.
  expect_matrix(imported.cameras[0].T_reference_camera * Eigen::Vector3d(1, 0, 0),
                Eigen::Vector3d(1, 3, 3));
}

TEST(BasaltFileTest, VisnavsLayoutIsReadOff) {
  const ImportedCameras imported = read(kVisnav);
  ASSERT_THAT(imported.cameras, SizeIs(2));
  EXPECT_TRUE(imported.reference_is_imu);
  EXPECT_EQ(std::get<DoubleSphereLens>(imported.cameras[0].camera.lens).shape().xi, -0.25);
  const auto& eucm = std::get<ExtendedUnifiedLens>(imported.cameras[1].camera.lens);
  EXPECT_EQ(eucm.shape().alpha, 0.6);
  EXPECT_EQ(eucm.shape().beta, 1.1);
  EXPECT_EQ(imported.cameras[1].camera.size_px, cv::Size(640, 400));
  expect_matrix(imported.cameras[1].T_reference_camera.translation(), Eigen::Vector3d(0.3, 0, 0));
}

TEST(BasaltFileTest, VisnavsFisheyeHasItsCoefficientsInP) {
  const ImportedCameras imported =
      read(replaced(replaced(replaced(kVisnav, "\"ds\"", "\"kb4\""), "\"p3\": 0.0", "\"p3\": 0.03"),
                    "\"p4\": 0.0",
                    "\"p4\": 0.04"));
  EXPECT_THAT(std::get<KannalaBrandtLens>(imported.cameras[0].camera.lens).distortion(),
              ElementsAre(-0.25, 0.6, 0.03, 0.04));
}

TEST(BasaltFileTest, ThePinholesAreRadialTangential) {
  const std::string radtan =
      R"("k1": 0.1, "k2": 0.2, "p1": 0.003, "p2": 0.004, "k3": 0.5, "k4": 0.06, "k5": 0.07,)"
      R"( "k6": 0.08, "rpmax": 2.5)";
  const ImportedCameras imported =
      read(replaced(replaced(replaced(kBasalt, "\"ds\"", "\"pinhole-radtan8\""),
                             "\"xi\": -0.25, \"alpha\": 0.6",
                             radtan),
                    "\"kb4\"",
                    "\"pinhole\""));
  EXPECT_THAT(std::get<RadialTangentialLens>(imported.cameras[0].camera.lens).distortion(),
              ElementsAre(0.1, 0.2, 0.003, 0.004, 0.5, 0.06, 0.07, 0.08));
  EXPECT_THAT(std::get<RadialTangentialLens>(imported.cameras[1].camera.lens).distortion(),
              ElementsAre(0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(BasaltFileTest, AQuaternionIsMadeAUnitOrRefused) {
  const ImportedCameras imported = read(replaced(kBasalt, "\"qw\": 1}", "\"qw\": 1.0005}"));
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], AllOf(HasSubstr("T_imu_cam[1]"), HasSubstr("quaternion")));
  expect_matrix(imported.cameras[1].T_reference_camera.linear(), Eigen::Matrix3d::Identity());
  expect_refused(kBasalt,
                 "calib.json",
                 {{"\"qw\": 1}", "\"qw\": 1.1}", {"value0.T_imu_cam[1]: the norm"}},
                  {"\"qw\": 1}", "\"qw\": 0}", {"value0.T_imu_cam[1]: the norm"}}},
                 read_file);
}

TEST(BasaltFileTest, AReferenceThatIsTheFirstCameraIsNamed) {
  const ImportedCameras imported = read(replaced(kVisnav, "\"px\": 0.1", "\"px\": 0.0"));
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], HasSubstr("cam.T_i_c of the first camera is the identity"));
}

TEST(BasaltFileTest, WhatIsWrongIsNamedByItsPath) {
  const std::vector<BadChange> changes = {
      {"value0", "value1", {"value0: this key is missing"}},
      {"T_imu_cam", "T_cam_imu", {"value0.T_imu_cam: this key is missing"}},
      {"\"resolution\"", "\"size\"", {"value0.resolution: this key is missing"}},
      {"\"intrinsics\": [", "\"lenses\": [", {"value0.intrinsics: this key is missing"}},
      {"\"camera_type\"", "\"type\"", {"value0.intrinsics[0].camera_type: this key is missing"}},
      {"\"fx\": 350", "\"f\": 350", {"value0.intrinsics[0].intrinsics.fx: this key is missing"}},
      {"\"k4\"", "\"k5\"", {"value0.intrinsics[1].intrinsics.k4: this key is missing"}},
      {"\"px\": 1.5", "\"x\": 1.5", {"value0.T_imu_cam[1].px: this key is missing"}},
      {", [640, 400]", "", {"value0.resolution: expected 2 entries", "found 1"}},
      {"[640, 400]", "[640]", {"value0.resolution[1]: expected width and height"}},
      {"[640, 400]", "[640, -400]", {"value0.resolution[1][1]: expected a whole"}},
      {"[640, 400]", "[16385, 400]", {"value0.resolution[1][0]: expected", "1...16384"}},
      {"\"fx\": 350", "\"fx\": null", {"value0.intrinsics[0].intrinsics.fx: expected a finite"}},
      {"\"fx\": 350", "\"fx\": NaN", {"value0.intrinsics[0].intrinsics.fx: expected", "NaN"}},
      {"\"fx\": 350", "\"fx\": 35x", {":8: not valid JSON"}},
      {"\"fx\": 350", "\"fx\": \"350\"", {"value0.intrinsics[0].intrinsics.fx: expected a finite"}},
      {"\"fx\": 350", "\"fx\": -350", {"value0.intrinsics[0].intrinsics: "}},
      {"0.6", "1.6", {"value0.intrinsics[0].intrinsics: ", "alpha"}},
      {"\"ds\"", "\"ucm\"", {"value0.intrinsics[0].camera_type: 'ucm'", "ds, eucm, kb4"}}};
  expect_refused(kBasalt, "calib.json", changes, read_file);
  expect_refused(
      kVisnav,
      "calib.json",
      {{"cam.T_i_c", "T_i_c", {"value0.cam.T_i_c: this key is missing"}},
       {"\"p2\"", "\"p9\"", {"value0.cam.intrinsics[0].p2: this key is missing"}},
       {"\"width\": 752", "\"width\": 0", {"value0.cam.intrinsics[0].width: expected a whole"}},
       {"\"width\": 752", "\"width\": 16385", {"value0.cam.intrinsics[0].width", "1...16384"}},
       {"\"eucm\"", "\"fov\"", {"value0.cam.intrinsics[1].cam_type: 'fov'"}}},
      read_file);
  testing::expect_no_content_refused("calib.json", read_file);
}

TEST(BasaltFileSystem, TheRecordedCalibrationsHaveTheirBaseline) {
  const auto folder = recorded_data() / "euroc_V1_01_flight/calib";
  SKYHALO_SKIP_WITHOUT(folder);
  for (const std::string name : {"euroc_ds_calib_basalt",
                                 "euroc_ds_calib_visnav",
                                 "gt_calib_ds",
                                 "gt_calib_eucm",
                                 "gt_calib_kb4",
                                 "gt_calib_pinhole"}) {
    SCOPED_TRACE(name);
    const ImportedCameras imported = read_basalt(folder / (name + ".json"));
    const RigDescription rig = assemble_rig(imported, {}, name);
    const RawPair& pair = std::get<RawPairDescription>(rig.pairs.at(0).images).cameras;
    EXPECT_EQ(pair.left.size_px, cv::Size(752, 480));
    EXPECT_NEAR(pair.T_right_left.translation().norm(), 0.110, 5e-4);
    EXPECT_LT(pair.T_right_left.translation().x(), -0.109);
    EXPECT_EQ(rig.pairs[0].name, "front");
  }
}

TEST(BasaltFileSystem, BothLayoutsOfOneCalibrationSayTheSame) {
  const auto folder = recorded_data() / "euroc_V1_01_flight/calib";
  SKYHALO_SKIP_WITHOUT(folder);
  const ImportedCameras basalt = read_basalt(folder / "euroc_ds_calib_basalt.json");
  const ImportedCameras visnav = read_basalt(folder / "euroc_ds_calib_visnav.json");
  for (const std::size_t i : {0U, 1U}) {
    const auto& a = std::get<DoubleSphereLens>(basalt.cameras.at(i).camera.lens);
    const auto& b = std::get<DoubleSphereLens>(visnav.cameras.at(i).camera.lens);
    EXPECT_EQ(a.intrinsics().fx_px, b.intrinsics().fx_px);
    EXPECT_EQ(a.shape().xi, b.shape().xi);
    EXPECT_EQ(a.shape().alpha, b.shape().alpha);
    expect_matrix(basalt.cameras[i].T_reference_camera.matrix(),
                  visnav.cameras[i].T_reference_camera.matrix(),
                  0.0);
  }
}

}  // namespace
}  // namespace skyhalo
