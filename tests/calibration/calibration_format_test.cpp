#include "skyhalo/calibration/calibration_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(CalibrationFormatTest, EveryFormatHasAName) {
  EXPECT_EQ(name_of(CalibrationFormat::kAuto), "auto");
  EXPECT_EQ(name_of(CalibrationFormat::kKalibr), "kalibr");
  EXPECT_EQ(name_of(CalibrationFormat::kEuroc), "euroc");
  EXPECT_EQ(name_of(CalibrationFormat::kOpencv), "opencv");
  EXPECT_EQ(name_of(CalibrationFormat::kRos), "ros");
  EXPECT_EQ(name_of(CalibrationFormat::kBasalt), "basalt");
  EXPECT_EQ(name_of(CalibrationFormat::kKittiRaw), "kitti_raw");
  EXPECT_EQ(name_of(CalibrationFormat::kKittiTracking), "kitti_tracking");
}

TEST(CalibrationFormatTest, AFormatIsRecognisedByWhatTheFileHolds) {
  const TempFolder folder;
  const auto format = [&](const std::string& text) {
    return recognise_format({folder.write("file", text)});
  };
  EXPECT_EQ(format("%YAML:1.0\n\ncam0:\n  camera_model: ds\n"), CalibrationFormat::kKalibr);
  EXPECT_EQ(format("# x\r\nT_BS:\r\n  cols: 4\r\n"), CalibrationFormat::kEuroc);
  EXPECT_EQ(format("%YAML:1.0\n---\nM1: !!opencv-matrix\n"), CalibrationFormat::kOpencv);
  EXPECT_EQ(format("<?xml version=\"1.0\"?>\n<opencv_storage>\n<cameraMatrix1>"),
            CalibrationFormat::kOpencv);
  EXPECT_EQ(format("{\n  \"M1\": {}}"), CalibrationFormat::kOpencv);
  EXPECT_EQ(format("image_width: 640\ncamera_name: a\ncamera_matrix:\n"), CalibrationFormat::kRos);
  EXPECT_EQ(format("camera_matrix:\nprojection_matrix:\n"), CalibrationFormat::kRos);
  EXPECT_EQ(format(" {\n\"value0\" : {}}"), CalibrationFormat::kBasalt);
  EXPECT_EQ(format("calib_time: x\nP_rect_00: 1\n"), CalibrationFormat::kKittiRaw);
  EXPECT_EQ(format("P0: 1\nP1: 1\nP2: 1\nP3: 1\nR_rect 1\n"), CalibrationFormat::kKittiTracking);
}

TEST(CalibrationFormatTest, SeveralFilesAreTakenTogether) {
  const TempFolder folder;
  EXPECT_EQ(recognise_format({folder.write("extrinsics.yml", "%YAML:1.0\n---\nR: x\nT: x\n"),
                              folder.write("intrinsics.yml", "%YAML:1.0\n---\nK2: x\n")}),
            CalibrationFormat::kOpencv);
}

TEST(CalibrationFormatTest, FoldersAreRecognised) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { (void)recognise_format({folder.path()}); }),
              AllOf(HasSubstr(folder.path().string()), HasSubstr("no calibration that is known")));
  (void)folder.write("day/calib_cam_to_cam.txt", "P_rect_00: 1\n");
  (void)folder.write("run/mav0/cam0/sensor.yaml", "T_BS: 1\n");
  EXPECT_EQ(recognise_format({folder.path() / "day"}), CalibrationFormat::kKittiRaw);
  EXPECT_EQ(recognise_format({folder.path() / "run"}), CalibrationFormat::kEuroc);
}

TEST(CalibrationFormatTest, WhenNothingFitsTheKnownOnesAreListed) {
  const TempFolder folder;
  for (const std::string text :
       {"hello\n", "{\"a\": 1}", "<html>", "\"", "pairs:\n- name: front\n"}) {
    SCOPED_TRACE(text);
    EXPECT_THAT(message_of([&] { (void)recognise_format({folder.write("a.yaml", text)}); }),
                AllOf(HasSubstr((folder.path() / "a.yaml").string()),
                      HasSubstr("Kalibr"),
                      HasSubstr("EuRoC"),
                      HasSubstr("OpenCV"),
                      HasSubstr("ROS"),
                      HasSubstr("Basalt"),
                      HasSubstr("KITTI")));
  }
}

TEST(CalibrationFormatTest, WhatIsNoTextIsRefused) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& text) {
    return message_of([&] { (void)recognise_format({folder.write("a.yaml", text)}); });
  };
  EXPECT_THAT(refusal(""), AllOf(HasSubstr("a.yaml"), HasSubstr("is empty")));
  EXPECT_THAT(refusal(" \n"), AllOf(HasSubstr("a.yaml"), HasSubstr("is empty")));
  EXPECT_THAT(refusal(std::string("cam0:\0\x01", 7)),
              AllOf(HasSubstr("a.yaml"), HasSubstr("is a binary file")));
  EXPECT_THAT(message_of([&] { (void)recognise_format({folder.path() / "none"}); }),
              AllOf(HasSubstr("none"), HasSubstr("no such file")));
  EXPECT_THAT(message_of([&] { (void)recognise_format({}); }), HasSubstr("expected a calibration"));
}

TEST(CalibrationFormatTest, AFolderThatCannotBeReadIsNamed) {
  const TempFolder folder;
  const auto path = folder.path() / std::string(5000, 'x');
  EXPECT_THAT(message_of([&] { (void)recognise_format({path}); }), HasSubstr(path.string()));
}

}  // namespace
}  // namespace skyhalo
