#include "skyhalo/dataset/kitti_raw.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/recorded_data.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::DrivePaths;
using ::testing::HasSubstr;
using testing::message_of;
using testing::SyntheticDrive;
using testing::TempFolder;
using testing::write_drive;

constexpr DatasetConfig kAuto{};
constexpr DatasetConfig kGrey{.cameras = CameraChoice::kGrey};
constexpr DatasetConfig kColour{.cameras = CameraChoice::kColour};

void expect_point(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-6) << actual.transpose();
}

TEST(KittiRawTest, RecognisesADrive) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 1}, folder.path());
  EXPECT_TRUE(is_kitti_raw_drive(paths.drive));
  EXPECT_FALSE(is_kitti_raw_drive(paths.day));
  EXPECT_FALSE(is_kitti_raw_drive(paths.drive / "oxts"));
  EXPECT_FALSE(is_kitti_raw_drive(folder.path() / "missing"));
  fs::rename(paths.drive / "image_00", paths.drive / "image_02");
  EXPECT_TRUE(is_kitti_raw_drive(paths.drive));
  fs::remove_all(paths.drive / "oxts");
  EXPECT_FALSE(is_kitti_raw_drive(paths.drive));
}

TEST(KittiRawTest, KnowsItsFramesAndStamps) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 3}, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  EXPECT_EQ(drive.name(), "2011_09_26_drive_0099_sync");
  EXPECT_EQ(drive.frame_count(), 3);
  EXPECT_EQ((drive.stamp(2) - drive.stamp(0)).count(), 250'000'000);  // 0.125 s a frame
}

TEST(KittiRawTest, ATrailingSlashDoesNotChangeTheName) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 1}, folder.path());
  const KittiRawDrive drive(paths.drive / "", kAuto);
  EXPECT_EQ(drive.name(), "2011_09_26_drive_0099_sync");
  EXPECT_EQ(drive.frame_count(), 1);
}

TEST(KittiRawTest, TheMapFrameIsTheFirstBody) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 3, .step_m = 0.5}, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  for (int frame = 0; frame < 3; ++frame) {
    expect_point(drive.T_map_body(frame).translation(), {0.5 * frame, 0.0, 0.0});
    EXPECT_TRUE(drive.T_map_body(frame).linear().isIdentity(1e-9));
  }
}

TEST(KittiRawTest, TheMapFrameTurnsWithTheFirstBody) {
  // Yaw 90 deg: the first body looks north. A metre to the east is then a metre to the right.
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 2, .step_m = 1.0}, folder.path());
  for (const int frame : {0, 1}) {
    const fs::path file = paths.drive / "oxts/data" / testing::synthetic_name(frame, ".txt");
    std::string line = testing::oxts_line(frame);
    line.replace(line.find(" 0 0 0"), 6, " 0 0 1.5707963267948966");
    testing::write_text(file, line);
  }
  const KittiRawDrive drive(paths.drive, kAuto);
  expect_point(drive.T_map_body(1).translation(), {0.0, -1.0, 0.0});
}

TEST(KittiRawTest, TheRigIsTheCalibratedPair) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 1}, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  ASSERT_EQ(drive.rig().pairs.size(), 1U);
  const StereoPair& pair = drive.rig().pairs[0];
  EXPECT_FALSE(pair.name.empty());
  EXPECT_EQ(pair.image_size_px, cv::Size(320, 96));
  EXPECT_EQ(std::get<PinholePair>(pair.model).focal_px, 256.0);
  EXPECT_NEAR(std::get<PinholePair>(pair.model).baseline_m, 0.5, 1e-9);
  // Scanner at (0.75, 0, 0.5), left camera at (0.25, 0.25, -0.125) of it, the right one 0.5 m to
  // the right.
  expect_point(pair.T_body_camera.translation(), {1.0, -0.25, 0.375});
}

TEST(KittiRawTest, ReadsTheImagesOfAFrame) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 2}, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  const FrameSet frames = drive.read(1);
  EXPECT_EQ(frames.stamp, drive.stamp(1));
  ASSERT_EQ(frames.pairs.size(), 1U);
  const cv::Mat left = read_image(paths.drive / "image_00/data/0000000001.png");
  const cv::Mat right = read_image(paths.drive / "image_01/data/0000000001.png");
  EXPECT_EQ(cv::norm(frames.pairs[0].left, left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frames.pairs[0].right, right, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(left, right, cv::NORM_INF), 0.0);
}

TEST(KittiRawTest, CamerasAreChosen) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 1, .colour_too = true}, folder.path());
  EXPECT_EQ(KittiRawDrive(paths.drive, kAuto).read(0).pairs[0].left.channels(), 1);
  EXPECT_EQ(KittiRawDrive(paths.drive, kGrey).read(0).pairs[0].left.channels(), 1);
  EXPECT_EQ(KittiRawDrive(paths.drive, kColour).read(0).pairs[0].left.channels(), 3);
  fs::remove_all(paths.drive / "image_00");
  EXPECT_EQ(KittiRawDrive(paths.drive, kAuto).read(0).pairs[0].left.channels(), 3);
  EXPECT_THAT(message_of([&] { const KittiRawDrive drive(paths.drive, kGrey); }),
              HasSubstr("image_00"));
}

TEST(KittiRawTest, TheScanLiesOnTheWall) {
  const TempFolder folder;
  const SyntheticDrive world{.frames = 3};
  const DrivePaths paths = write_drive(world, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  const auto scan = drive.read_scan(2);
  ASSERT_TRUE(scan.has_value());
  EXPECT_EQ(scan->size(), 48U * 16U);
  for (const Eigen::Vector3f& point : *scan) {
    const Eigen::Vector3d p_map_m =
        drive.T_map_body(2) * (drive.T_body_laser() * point.cast<double>());
    EXPECT_NEAR(p_map_m.x(), world.wall_x_m, 1e-5);
  }
}

TEST(KittiRawTest, AMissingScanIsNone) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 2}, folder.path());
  fs::remove(paths.drive / "velodyne_points/data/0000000001.bin");
  const KittiRawDrive drive(paths.drive, kAuto);
  EXPECT_TRUE(drive.read_scan(0).has_value());
  EXPECT_FALSE(drive.read_scan(1).has_value());
  testing::write_text(paths.drive / "velodyne_points/data/0000000001.bin", "12345");
  EXPECT_THAT(message_of([&] { (void)drive.read_scan(1); }), HasSubstr("0000000001.bin"));
}

TEST(KittiRawTest, TheTruthCameraIsTheLeftOne) {
  // The scanner's point (8.25 + 0.25, 0.25 - 1, -0.125 - 0.5) is 8.25 m ahead, 1 m to the right and
  // 0.5 m below the left camera.
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 1}, folder.path());
  const KittiRawDrive drive(paths.drive, kAuto);
  const TruthCamera camera = drive.truth_camera();
  EXPECT_EQ(camera.focal_px, 256.0);
  EXPECT_NEAR(camera.principal_u_px, 160.0, 1e-9);
  EXPECT_NEAR(camera.principal_v_px, 48.0, 1e-9);
  EXPECT_EQ(camera.image_size_px, cv::Size(320, 96));
  expect_point(camera.T_camera_laser * Eigen::Vector3d(8.5, -0.75, -0.625), {1.0, 0.5, 8.25});
  // Annotations are in camera 00, here the same.
  expect_point(drive.T_annotation_laser() * Eigen::Vector3d(8.5, -0.75, -0.625), {1.0, 0.5, 8.25});
}

TEST(KittiRawTest, AMissingImageIsNamedAtOnce) {
  for (const std::string name : {"image_00/data/0000000001.png", "image_01/data/0000000002.png"}) {
    const TempFolder folder;
    const DrivePaths paths = write_drive({.frames = 4}, folder.path());
    fs::remove(paths.drive / name);
    EXPECT_THAT(message_of([&] { const KittiRawDrive drive(paths.drive, kAuto); }),
                HasSubstr((paths.drive / name).string()));
  }
}

TEST(KittiRawTest, AnotherFileThatIsMissingIsNamedAtOnce) {
  for (const std::string name :
       {"oxts/data/0000000001.txt", "image_00/timestamps.txt", "../calib_cam_to_cam.txt"}) {
    const TempFolder folder;
    const DrivePaths paths = write_drive({.frames = 2}, folder.path());
    fs::remove(paths.drive / name);
    EXPECT_THAT(message_of([&] { const KittiRawDrive drive(paths.drive, kAuto); }),
                HasSubstr((paths.drive / name).lexically_normal().string()));
  }
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { const KittiRawDrive drive(folder.path() / "none", kAuto); }),
              HasSubstr((folder.path() / "none").string()));
}

TEST(KittiRawTest, AnImageOfAnotherSizeIsNamed) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 2}, folder.path());
  const fs::path file = paths.drive / "image_00/data/0000000001.png";
  write_png(file, testing::texture({318, 96}, 1));
  const KittiRawDrive drive(paths.drive, kAuto);
  EXPECT_NO_THROW((void)drive.read(0));
  EXPECT_THAT(message_of([&] { (void)drive.read(1); }), HasSubstr(file.string()));
}

TEST(KittiRawTest, ADamagedImageIsNamed) {
  const TempFolder folder;
  const DrivePaths paths = write_drive({.frames = 2}, folder.path());
  const fs::path file = paths.drive / "image_01/data/0000000001.png";
  fs::resize_file(file, fs::file_size(file) / 2);
  const KittiRawDrive drive(paths.drive, kAuto);
  EXPECT_THAT(message_of([&] { (void)drive.read(1); }), HasSubstr(file.string()));
}

TEST(KittiRawSystem, ARecordedDriveOpens) {
  SKYHALO_SKIP_WITHOUT(testing::recorded_drive());
  const KittiRawDrive drive(testing::recorded_drive(), kAuto);
  ASSERT_GT(drive.frame_count(), 10);
  // KITTI's grey pair: f = 721.5377, B = 0.537 m; frames come at 10 Hz; the car drives ahead.
  EXPECT_NEAR(std::get<PinholePair>(drive.rig().pairs[0].model).focal_px, 721.5377, 1e-3);
  EXPECT_NEAR(std::get<PinholePair>(drive.rig().pairs[0].model).baseline_m, 0.537, 0.01);
  EXPECT_NEAR(static_cast<double>((drive.stamp(10) - drive.stamp(0)).count()) * 1e-9, 1.035, 0.06);
  EXPECT_GT(drive.T_map_body(10).translation().x(), 1.0);
  EXPECT_EQ(drive.read(0).pairs[0].left.size(), drive.rig().pairs[0].image_size_px);
}

}  // namespace
}  // namespace skyhalo
