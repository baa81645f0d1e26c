#include "skyhalo/calibration/calibration_import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::expect_matrix;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::recorded_data;
using testing::replaced;
using ::testing::SizeIs;
using testing::TempFolder;

/// Two cameras 0.2 m apart, level, off an IMU with the body's axes.
const std::string kKalibr =
    "cam0:\n"
    "  T_cam_imu: [[0, -1, 0, 0.1], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]]\n"
    "  camera_model: ds\n"
    "  intrinsics: [-0.25, 0.6, 350, 351, 320, 240]\n"
    "  resolution: [640, 480]\n"
    "cam1:\n"
    "  T_cam_imu: [[0, -1, 0, -0.1], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]]\n"
    "  camera_model: ds\n"
    "  intrinsics: [-0.25, 0.6, 350, 351, 320, 240]\n"
    "  resolution: [640, 480]\n";

TEST(CalibrationImportTest, ARigComesOutOfAFile) {
  const TempFolder folder;
  const ImportResult result =
      import_calibration({folder.write("chain", kKalibr)}, {.name = "drone"});
  EXPECT_EQ(result.format, CalibrationFormat::kKalibr);
  EXPECT_EQ(result.rig.name, "drone");
  EXPECT_THAT(result.warnings, IsEmpty());
  ASSERT_THAT(result.rig.pairs, SizeIs(1));
  EXPECT_EQ(result.rig.pairs[0].name, "front");
  // The right camera is 0.1 m to the right of the IMU.
  expect_matrix(result.rig.pairs[0].T_body_camera.translation(), Eigen::Vector3d(0, -0.1, 0));
  EXPECT_EQ(import_calibration({folder.write("chain", kKalibr)}, {}).rig.name, "kalibr");
}

TEST(CalibrationImportTest, TheMountingIsPassedOn) {
  const TempFolder folder;
  const ImportResult result = import_calibration(
      {folder.write("chain", kKalibr)},
      {.mounting = {.facing = Facing::kLeft, .body_at_imu = false}, .name = "drone"});
  EXPECT_EQ(result.rig.pairs.at(0).name, "left");
  expect_matrix(result.rig.pairs[0].T_body_camera.translation(), Eigen::Vector3d::Zero());
}

TEST(CalibrationImportTest, WarningsArePassedOn) {
  const TempFolder folder;
  const std::string text = replaced(kKalibr, "[[0, -1, 0, 0.1]", "[[0, -1.0002, 0, 0.1]");
  EXPECT_THAT(import_calibration({folder.write("chain", text)}, {}).warnings, SizeIs(1));
}

TEST(CalibrationImportTest, AFormatThatIsGivenIsNotGuessed) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] {
                (void)import_calibration({folder.write("chain", kKalibr)},
                                         {.format = CalibrationFormat::kEuroc});
              }),
              HasSubstr("distortion_model: this key is missing"));
}

TEST(CalibrationImportTest, ThePairMustHaveABaseline) {
  const TempFolder folder;
  const auto file = folder.write("chain", replaced(kKalibr, "-0.1]", "0.1]"));
  EXPECT_THAT(message_of([&] { (void)import_calibration({file}, {}); }),
              AllOf(HasSubstr(file.string()), HasSubstr("cam0 and cam1"), HasSubstr("baseline")));
}

TEST(CalibrationImportTest, ASizeThatIsGivenMustBeTheFiles) {
  const TempFolder folder;
  const auto file = folder.write("chain", kKalibr);
  EXPECT_EQ(import_calibration({file}, {.size_px = cv::Size(640, 480)}).rig.pairs.size(), 1U);
  EXPECT_THAT(
      message_of([&] { (void)import_calibration({file}, {.size_px = cv::Size(320, 240)}); }),
      AllOf(HasSubstr(file.string()), HasSubstr("640x480"), HasSubstr("320x240")));
}

TEST(CalibrationImportTest, TheNumberOfFilesMustFitTheFormat) {
  const TempFolder folder;
  const auto file = folder.write("chain", kKalibr);
  const auto refusal = [&](const std::vector<std::filesystem::path>& files,
                           CalibrationFormat format) {
    return message_of([&] { (void)import_calibration(files, {.format = format}); });
  };
  EXPECT_EQ(refusal({file, file}, CalibrationFormat::kAuto), "kalibr: expected 1 file, found 2");
  EXPECT_EQ(refusal({file}, CalibrationFormat::kRos), "ros: expected 2 files, found 1");
  EXPECT_EQ(refusal({file, file, file}, CalibrationFormat::kOpencv),
            "opencv: expected 1 or 2 files, found 3");
  EXPECT_THAT(refusal({}, CalibrationFormat::kKalibr), HasSubstr("expected a calibration file"));
}

const std::string kTracking =
    "P2: 256 0 160 0 0 256 48 0 0 0 1 0\n"
    "P3: 256 0 160 -128 0 256 48 0 0 0 1 0\n"
    "R_rect 1 0 0 0 1 0 0 0 1\n"
    "Tr_velo_cam 0 -1 0 0.25 0 0 -1 -0.125 1 0 0 -0.25\n"
    "Tr_imu_velo 1 0 0 -0.75 0 1 0 0 0 0 1 -0.5\n";

TEST(CalibrationImportTest, KittiKeepsItsBodyOrIsMountedAtTheCamera) {
  const TempFolder folder;
  const auto file = folder.write("0003.txt", kTracking);
  const cv::Size size_px(1242, 375);
  const ImportResult at_imu = import_calibration({file}, {.size_px = size_px});
  EXPECT_EQ(at_imu.format, CalibrationFormat::kKittiTracking);
  const Eigen::Vector3d right_m(1.0, -0.25, 0.375);
  expect_matrix(at_imu.rig.pairs.at(0).T_body_camera.translation(), right_m);
  const ImportResult at_camera =
      import_calibration({file}, {.mounting = {.body_at_imu = false}, .size_px = size_px});
  expect_matrix(at_camera.rig.pairs.at(0).T_body_camera.translation(), Eigen::Vector3d::Zero());
  expect_matrix(at_camera.rig.T_body_imu->translation(), -right_m);
}

TEST(CalibrationImportSystem, RecordedCalibrationsAreRecognised) {
  const auto data = recorded_data();
  SKYHALO_SKIP_WITHOUT(data / "euroc_V1_01_flight");
  SKYHALO_SKIP_WITHOUT(data / "fisheye_mynteye");
  SKYHALO_SKIP_WITHOUT(data / "kitti_raw/2011_09_26/calib_cam_to_cam.txt");
  EXPECT_EQ(import_calibration({data / "euroc_V1_01_flight"}, {}).format,
            CalibrationFormat::kEuroc);
  EXPECT_EQ(
      import_calibration({data / "euroc_V1_01_flight/calib/euroc_ds_calib_basalt.json"}, {}).format,
      CalibrationFormat::kBasalt);
  EXPECT_EQ(import_calibration({data / "fisheye_mynteye/left_sensor_fisheye.yaml",
                                data / "fisheye_mynteye/right_sensor_fisheye.yaml"},
                               {})
                .format,
            CalibrationFormat::kEuroc);
  const ImportResult kitti = import_calibration({data / "kitti_raw/2011_09_26"}, {});
  EXPECT_EQ(kitti.format, CalibrationFormat::kKittiRaw);
  const auto& images = std::get<RectifiedPairDescription>(kitti.rig.pairs.at(0).images);
  EXPECT_NEAR(std::get<PinholePair>(images.model).baseline_m, 0.5372, 5e-5);
}

TEST(CalibrationImportTest, AFacingThatKittiLeavesOutIsWarnedOf) {
  const TempFolder folder;
  const auto file = folder.write("0003.txt", kTracking);
  const auto warnings = [&](const Mounting& mounting) {
    return import_calibration({file}, {.mounting = mounting, .size_px = cv::Size(1242, 375)})
        .warnings;
  };
  ASSERT_THAT(warnings({.facing = Facing::kLeft}), SizeIs(1));
  EXPECT_THAT(warnings({.facing = Facing::kLeft})[0],
              AllOf(HasSubstr(file.string()), HasSubstr("which way the cameras look")));
  EXPECT_THAT(warnings({.facing = Facing::kForward}), IsEmpty());
  EXPECT_THAT(warnings({.facing = Facing::kLeft, .body_at_imu = false}), IsEmpty());
}

TEST(CalibrationImportTest, ASizeThatIsGivenIsWithinTheLimits) {
  const TempFolder folder;
  const auto file = folder.write("0003.txt", kTracking);
  for (const cv::Size& bad : {cv::Size(16385, 375), cv::Size(1242, 16385), cv::Size(0, 375)}) {
    EXPECT_THAT(message_of([&] { (void)import_calibration({file}, {.size_px = bad}); }),
                HasSubstr(file.string() + ": size_px: expected a whole number of pixels in 1..."));
  }
}

TEST(CalibrationImportTest, OpencvFilesMayBeTakenForFisheyes) {
  const std::string text =
      "M1: [ 400, 0, 320, 0, 400, 240, 0, 0, 1 ]\nD1: [ 0.1, 0.02, 0.003, 0.004 ]\n"
      "M2: [ 400, 0, 320, 0, 400, 240, 0, 0, 1 ]\nD2: [ 0.1, 0.02, 0.003, 0.004 ]\n"
      "R: [ 1, 0, 0, 0, 1, 0, 0, 0, 1 ]\nT: [ -0.2, 0, 0 ]\nimage_size: [ 640, 480 ]\n";
  const TempFolder folder;
  const auto file = folder.write("stereo.yml", text);
  const auto lens = [](const ImportResult& result) {
    return std::get<RawPairDescription>(result.rig.pairs.at(0).images).cameras.left.lens;
  };
  const ImportResult plain = import_calibration({file}, {});
  EXPECT_TRUE(std::holds_alternative<RadialTangentialLens>(lens(plain)));
  EXPECT_THAT(plain.warnings, SizeIs(2));
  const ImportResult fisheye = import_calibration({file}, {.opencv_fisheye = true});
  EXPECT_TRUE(std::holds_alternative<KannalaBrandtLens>(lens(fisheye)));
  EXPECT_THAT(fisheye.warnings, IsEmpty());
}

TEST(CalibrationImportTest, DeepNestingIsRefusedWhateverTheFormat) {
  const TempFolder folder;
  const std::string deep(200000, '[');
  for (const std::string& text : {"M1: " + deep, "{\"M1\": " + deep, "cam0: " + deep}) {
    SCOPED_TRACE(text.substr(0, 10));
    const auto file = folder.write("deep", text);
    for (const CalibrationFormat format : {CalibrationFormat::kAuto,
                                           CalibrationFormat::kOpencv,
                                           CalibrationFormat::kKalibr,
                                           CalibrationFormat::kBasalt}) {
      EXPECT_THAT(message_of([&] { (void)import_calibration({file}, {.format = format}); }),
                  HasSubstr(file.string()));
    }
  }
}

}  // namespace
}  // namespace skyhalo
