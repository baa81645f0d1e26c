#include "skyhalo/dataset/kitti_tracking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// As in KITTI's files; camera 0 stands apart from the pair, as there.
const std::string kCalibration =
    "P0: 256 0 160 0 0 256 48 0 0 0 1 0\n"
    "P1: 256 0 160 -128 0 256 48 0 0 0 1 0\n"
    "P2: 256 0 160 16 0 256 48 0 0 0 1 0\n"
    "P3: 256 0 160 -112 0 256 48 0 0 0 1 0\n"
    "R_rect 1 0 0 0 1 0 0 0 1\n"
    "Tr_velo_cam 0 -1 0 0.25 0 0 -1 -0.125 1 0 0 -0.25\n"
    "Tr_imu_velo 1 0 0 -0.75 0 1 0 0 0 0 1 -0.5\n\n";

/// A sequence of frames that go 0.5 m ahead each, and its training folder.
fs::path write_sequence(const TempFolder& folder, int frames, const std::string& name = "0003") {
  const fs::path training = folder.path() / "kitti/training";
  std::string oxts;
  for (int frame = 0; frame < frames; ++frame) {
    oxts += testing::oxts_line(0.5 * frame);
    const std::string number = "00000" + std::to_string(frame);
    for (const char* const camera : {"image_02", "image_03"}) {
      fs::create_directories(training / camera / name);
      write_png(training / camera / name / (number + ".png"),
                testing::texture({320, 96}, static_cast<unsigned>(2 * frame + camera[7])));
    }
    fs::create_directories(training / "velodyne" / name);
    write_velodyne(training / "velodyne" / name / (number + ".bin"),
                   testing::some_scan(static_cast<unsigned>(frame)));
  }
  testing::write_text(training / "oxts" / (name + ".txt"), oxts);
  testing::write_text(training / "calib" / (name + ".txt"), kCalibration);
  return training;
}

TEST(KittiTrackingTest, RecognisesTheLayout) {
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 1);
  EXPECT_TRUE(is_kitti_tracking(training));
  EXPECT_TRUE(is_kitti_tracking(training.parent_path()));
  EXPECT_FALSE(is_kitti_tracking(training / "calib"));
  EXPECT_FALSE(is_kitti_tracking(folder.path()));
  EXPECT_FALSE(is_kitti_tracking(folder.path() / "none"));
  const testing::DrivePaths drive =
      testing::write_drive({.frames = 1, .colour_too = true}, folder.path());
  EXPECT_FALSE(is_kitti_tracking(drive.drive));
  EXPECT_FALSE(is_kitti_tracking(drive.day));
}

TEST(KittiTrackingTest, ListsItsSequences) {
  const TempFolder folder;
  write_sequence(folder, 1, "0011");
  const fs::path training = write_sequence(folder, 1, "0002");
  testing::write_text(training / "calib/readme.txt", "");
  testing::write_text(training / "calib/00020.txt", "");
  testing::write_text(training / "calib/0004.bak", "");
  EXPECT_THAT(kitti_tracking_sequences(training), ElementsAre("0002", "0011"));
  EXPECT_THAT(kitti_tracking_sequences(training.parent_path()), ElementsAre("0002", "0011"));
  EXPECT_THAT(message_of([&] { (void)kitti_tracking_sequences(folder.path()); }),
              HasSubstr("is no folder of KITTI's tracking benchmark"));
}

TEST(KittiTrackingTest, KnowsItsFramesStampsAndPoses) {
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 3);
  for (const fs::path& path : {training, training.parent_path(), training / ""}) {
    const KittiTrackingSequence sequence(path, "0003");
    EXPECT_EQ(sequence.name(), "0003");
    ASSERT_EQ(sequence.frame_count(), 3);
    EXPECT_EQ(sequence.stamp(2).time_since_epoch().count(), 200'000'000);
    EXPECT_TRUE(sequence.T_map_body(0).isApprox(Pose::Identity(), 1e-9));
    EXPECT_LT((sequence.T_map_body(2).translation() - Eigen::Vector3d(1.0, 0.0, 0.0)).norm(), 1e-6);
    EXPECT_EQ(sequence.label_file(),
              (path.filename() == "kitti" ? training : path) / "label_02/0003.txt");
  }
}

TEST(KittiTrackingTest, TheColourPairAndTheTruthCameraStandWhereTheyStand) {
  const TempFolder folder;
  const KittiTrackingSequence sequence(write_sequence(folder, 1), "0003");
  const StereoPair& pair = sequence.rig().pairs.at(0);
  EXPECT_EQ(pair.image_size_px, cv::Size(320, 96));
  EXPECT_NEAR(std::get<PinholePair>(pair.model).baseline_m, 0.5, 1e-12);
  // Camera 0 is at (1, 0.25, 0.375) of the body (as in the raw drive of the tests); camera 2 is
  // 16/256 m to its left, camera 3 112/256 m to its right.
  EXPECT_TRUE(
      pair.T_body_camera.translation().isApprox(Eigen::Vector3d(1.0, 0.25 - 0.4375, 0.375), 1e-9));
  // 8.25 m ahead of camera 0, 1 m to the right and 0.5 m below it.
  const Eigen::Vector3d p(8.5, -0.75, -0.625);
  EXPECT_TRUE((sequence.T_annotation_laser() * p).isApprox(Eigen::Vector3d(1.0, 0.5, 8.25), 1e-9));
  const TruthCamera camera = sequence.truth_camera();
  EXPECT_TRUE((camera.T_camera_laser * p).isApprox(Eigen::Vector3d(1.0625, 0.5, 8.25), 1e-9));
  EXPECT_EQ(camera.image_size_px, cv::Size(320, 96));
  EXPECT_EQ(camera.principal_u_px, 160.0);
}

TEST(KittiTrackingTest, ReadsImagesAndScans) {
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 2);
  fs::remove(training / "velodyne/0003/000001.bin");
  const KittiTrackingSequence sequence(training, "0003");
  const FrameSet frames = sequence.read(1);
  EXPECT_EQ(frames.stamp, sequence.stamp(1));
  EXPECT_TRUE(testing::same_image(frames.pairs.at(0).left,
                                  read_image(training / "image_02/0003/000001.png")));
  EXPECT_TRUE(testing::same_image(frames.pairs.at(0).right,
                                  read_image(training / "image_03/0003/000001.png")));
  EXPECT_EQ(sequence.read_scan(0), testing::some_scan(0).points_m);
  EXPECT_FALSE(sequence.read_scan(1).has_value());
}

TEST(KittiTrackingTest, AnotherRigTakesThePlaceOfTheCalibrations) {
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 2);
  StereoRig rig = KittiTrackingSequence(training, "0003").rig();
  rig.pairs[0].name = "other";
  // This body's x is the INS's y: half a metre ahead is half a metre to its right.
  const Pose T_body_imu = make_pose(
      Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
      Eigen::Vector3d::Zero());
  const KittiTrackingSequence sequence(training, "0003", KittiRig{rig, T_body_imu});
  EXPECT_EQ(sequence.rig().pairs[0].name, "other");
  EXPECT_LT((sequence.T_map_body(1).translation() - Eigen::Vector3d(0.0, -0.5, 0.0)).norm(), 1e-6);
  EXPECT_TRUE(
      sequence.T_body_laser().translation().isApprox(Eigen::Vector3d(0.0, -0.75, 0.5), 1e-9));
  rig.pairs.push_back(rig.pairs[0]);
  EXPECT_THAT(message_of([&] {
                const KittiTrackingSequence s(training, "0003", KittiRig{rig, {}});
              }),
              HasSubstr("a rig of one pair"));
}

TEST(KittiTrackingTest, WhatIsMissingIsNamedAtOnce) {
  for (const std::string name : {"image_02/0003/000001.png",
                                 "image_03/0003/000000.png",
                                 "oxts/0003.txt",
                                 "calib/0003.txt"}) {
    const TempFolder folder;
    const fs::path training = write_sequence(folder, 2);
    fs::remove(training / name);
    EXPECT_THAT(message_of([&] { const KittiTrackingSequence s(training, "0003"); }),
                HasSubstr((training / name).string()));
  }
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 2);
  const auto refused = [&](const std::string& sequence) {
    return message_of([&] { const KittiTrackingSequence s(training, sequence); });
  };
  EXPECT_THAT(refused("3"), HasSubstr("four digits, found '3'"));
  EXPECT_THAT(refused("../3"), HasSubstr("four digits"));
  EXPECT_THAT(refused("0004"), HasSubstr("0004.txt: no such file"));
  testing::write_text(training / "oxts/0003.txt", testing::oxts_line(0.0));
  EXPECT_THAT(refused("0003"), HasSubstr("oxts/0003.txt: has lines for 1 frames"));
}

TEST(KittiTrackingTest, AnImageOfAnotherSizeIsNamed) {
  const TempFolder folder;
  const fs::path training = write_sequence(folder, 2);
  const fs::path file = training / "image_02/0003/000001.png";
  write_png(file, testing::texture({318, 96}, 1));
  const KittiTrackingSequence sequence(training, "0003");
  EXPECT_NO_THROW((void)sequence.read(0));
  EXPECT_THAT(message_of([&] { (void)sequence.read(1); }),
              HasSubstr(file.string() + ": has 318x96 pixels, expected 320x96"));
}

}  // namespace
}  // namespace skyhalo
