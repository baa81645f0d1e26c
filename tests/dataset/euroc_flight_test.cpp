#include "skyhalo/dataset/euroc_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/recorded_data.hpp"
#include "support/temp_folder.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr std::int64_t kStartNs = 1403715273262142976;
constexpr std::int64_t kStepNs = 50'000'000;
const cv::Size kSize(48, 32);

std::int64_t stamp_ns(int frame) {
  return kStartNs + frame * kStepNs;
}

/// A rig of one pair with images of these sizes.
StereoRig rig_of(const cv::Size& left, const cv::Size& right) {
  const RadialTangentialLens lens({30.0, 30.0, 24.0, 16.0}, {});
  StereoPair pair;
  pair.name = "front";
  pair.image_size_px = {40, 30};
  pair.model = PinholePair{30.0, 20.0, 15.0, 0.1};
  pair.raw = RawImaging{.left = {left, lens}, .right = {right, lens}};
  return {{pair}};
}

StereoRig small_rig() {
  return rig_of(kSize, kSize);
}

cv::Mat1b picture(int camera, int frame) {
  return testing::texture(kSize, static_cast<unsigned>(10 * frame + camera + 1));
}

/// A flight of `frames` frames without ground truth; camera `camera` lists and has them all.
fs::path write_camera(const TempFolder& folder, int camera, int frames) {
  const std::string name = "flight/mav0/cam" + std::to_string(camera);
  std::string list = "#timestamp [ns],filename\n";
  for (int frame = 0; frame < frames; ++frame) {
    const std::string file = std::to_string(stamp_ns(frame)) + ".png";
    list += std::to_string(stamp_ns(frame)) + "," + file + "\n";
    fs::create_directories(folder.path() / name / "data");
    write_png(folder.path() / name / "data" / file, picture(camera, frame));
  }
  folder.write(name + "/data.csv", list);
  return folder.path() / "flight";
}

fs::path write_flight(const TempFolder& folder, int frames) {
  write_camera(folder, 0, frames);
  return write_camera(folder, 1, frames);
}

std::string truth_line(std::int64_t ns, const std::string& position_and_quaternion) {
  return std::to_string(ns) + "," + position_and_quaternion + ",0,0,0,0,0,0,0,0,0\n";
}

void write_truth(const TempFolder& folder, const std::string& lines) {
  folder.write("flight/mav0/state_groundtruth_estimate0/data.csv", "#timestamp,...\n" + lines);
}

fs::path image_file(const fs::path& flight, int camera, int frame) {
  return flight / "mav0" / ("cam" + std::to_string(camera)) / "data" /
         (std::to_string(stamp_ns(frame)) + ".png");
}

void expect_point(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-6) << actual.transpose();
}

TEST(EurocFlightTest, RecognisesAFlight) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  EXPECT_TRUE(is_euroc_flight(flight));
  EXPECT_TRUE(is_euroc_flight(flight / "mav0"));
  EXPECT_TRUE(is_euroc_flight(flight / "mav0" / ""));
  EXPECT_FALSE(is_euroc_flight(flight / "mav0/cam0"));
  EXPECT_FALSE(is_euroc_flight(folder.path()));
  EXPECT_FALSE(is_euroc_flight(folder.path() / "none"));
  fs::remove_all(flight / "mav0/cam1");
  EXPECT_FALSE(is_euroc_flight(flight));
}

TEST(EurocFlightTest, KnowsItsFramesAndStamps) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 3);
  for (const fs::path& path : {flight, flight / "", flight / "mav0", flight / "mav0" / ""}) {
    const EurocFlight source(path, small_rig());
    EXPECT_EQ(source.name(), "flight");
    ASSERT_EQ(source.frame_count(), 3);
    EXPECT_EQ(source.stamp(0).time_since_epoch().count(), 1403715273262142976);
    EXPECT_EQ(source.stamp(2).time_since_epoch().count(), 1403715273362142976);
    EXPECT_EQ(source.dropped().unpaired, 0);
    EXPECT_EQ(source.dropped().without_image, 0);
    EXPECT_EQ(source.dropped().without_pose, 0);
  }
}

TEST(EurocFlightTest, Cam0IsTheLeftCamera) {
  const TempFolder folder;
  const EurocFlight source(write_flight(folder, 2), small_rig());
  const FrameSet frames = source.read(1);
  EXPECT_EQ(frames.stamp, source.stamp(1));
  ASSERT_EQ(frames.pairs.size(), 1U);
  EXPECT_EQ(cv::norm(frames.pairs[0].left, picture(0, 1), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frames.pairs[0].right, picture(1, 1), cv::NORM_INF), 0.0);
}

TEST(EurocFlightTest, AListedPngMayBeAJpeg) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  for (const int camera : {0, 1}) {
    fs::path file = image_file(flight, camera, 0);
    const cv::Mat image = read_image(file);
    fs::remove(file);
    cv::imwrite(file.replace_extension(".jpg").string(), image);
  }
  const EurocFlight source(flight, small_rig());
  EXPECT_EQ(source.read(0).pairs[0].right.size(), kSize);
}

TEST(EurocFlightTest, StampsOfOneCameraOnlyAreLeftOut) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 5);
  const auto list = [&](std::initializer_list<int> frames) {
    std::string text = "#timestamp [ns],filename\r\n";
    for (const int frame : frames) {
      text += std::to_string(stamp_ns(frame)) + "," + std::to_string(stamp_ns(frame)) + ".png \r\n";
    }
    return text;
  };
  folder.write("flight/mav0/cam0/data.csv", list({0, 1, 3, 4}));
  folder.write("flight/mav0/cam1/data.csv", list({1, 2, 3}));
  const EurocFlight source(flight, small_rig());
  ASSERT_EQ(source.frame_count(), 2);
  EXPECT_EQ(source.stamp(0).time_since_epoch().count(), stamp_ns(1));
  EXPECT_EQ(source.stamp(1).time_since_epoch().count(), stamp_ns(3));
  EXPECT_EQ(source.dropped().unpaired, 3);
  EXPECT_EQ(cv::norm(source.read(1).pairs[0].left, picture(0, 3), cv::NORM_INF), 0.0);
}

TEST(EurocFlightTest, PairsWithoutAnImageFileAreLeftOut) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 4);
  fs::remove(image_file(flight, 0, 0));
  fs::remove(image_file(flight, 1, 2));
  const EurocFlight source(flight, small_rig());
  EXPECT_EQ(source.frame_count(), 2);
  EXPECT_EQ(source.dropped().without_image, 2);
  EXPECT_EQ(source.stamp(0).time_since_epoch().count(), stamp_ns(1));
}

TEST(EurocFlightTest, TheMapIsLevelAndTurnedToTheFirstHeading) {
  // The IMU looks along the world's y and is pitched down by 30 degrees; then it is 2 m further
  // along y and 1 m higher, without pitch.
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 2);
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond down(
      Eigen::AngleAxisd(std::numbers::pi / 6.0, Eigen::Vector3d::UnitY()));
  const auto text = [](const Eigen::Quaterniond& q) {
    return std::to_string(q.w()) + "," + std::to_string(q.x()) + "," + std::to_string(q.y()) + "," +
           std::to_string(q.z());
  };
  write_truth(folder,
              truth_line(stamp_ns(0), "5,6,7," + text(yaw * down)) +
                  truth_line(stamp_ns(1), "5,8,8," + text(yaw)));
  const EurocFlight source(flight, small_rig());
  EXPECT_TRUE(source.has_poses());
  expect_point(source.T_map_body(0).translation(), {0.0, 0.0, 0.0});
  expect_point(source.T_map_body(1).translation(), {2.0, 0.0, 1.0});
  // Its x axis goes down by the pitch, its y axis stays level.
  expect_point(source.T_map_body(0).linear().col(0), {std::sqrt(0.75), 0.0, -0.5});
  expect_point(source.T_map_body(0).linear().col(1), {0.0, 1.0, 0.0});
  EXPECT_TRUE(source.T_map_body(1).linear().isIdentity(1e-5));
}

TEST(EurocFlightTest, TheBodyIsNotTheImu) {
  // The IMU sits 1 m above the body's origin with its x upwards and its z ahead (y to the right).
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 2);
  Eigen::Matrix3d R_body_imu;
  R_body_imu << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  const Pose T_body_imu = make_pose(R_body_imu, {0.0, 0.0, 1.0});
  // The body is level in a world whose x it looks along; the IMU is then turned as in the body.
  const Eigen::Quaterniond q(R_body_imu);
  const std::string turned = std::to_string(q.w()) + "," + std::to_string(q.x()) + "," +
                             std::to_string(q.y()) + "," + std::to_string(q.z());
  write_truth(
      folder,
      truth_line(stamp_ns(0), "0,0,1," + turned) + truth_line(stamp_ns(1), "3,0,1.5," + turned));
  const EurocFlight source(flight, small_rig(), T_body_imu);
  expect_point(source.T_map_body(1).translation(), {3.0, 0.0, 0.5});
  EXPECT_TRUE(source.T_map_body(0).linear().isIdentity(1e-5));
  EXPECT_TRUE(source.T_map_body(1).linear().isIdentity(1e-5));
  // Taken for the body, this IMU looks straight up; x is then right of its y axis, which points to
  // the world's -y: the world's -x.
  const EurocFlight upright(flight, small_rig());
  expect_point(upright.T_map_body(1).translation(), {-3.0, 0.0, 0.5});
}

TEST(EurocFlightTest, PosesAreInterpolatedAndGapsLeftOut) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 10);
  const std::string level = ",0,0,1,0,0,0";
  // Frames 0 and 9 lie outside; 5, 6 and 7 in a gap of 0.21 s.
  write_truth(folder,
              truth_line(stamp_ns(1), "0" + level) +
                  truth_line(stamp_ns(2) + kStepNs / 2, "3" + level) +
                  truth_line(stamp_ns(4) + 10'000'000, "4" + level) +
                  truth_line(stamp_ns(8) + 20'000'000, "5" + level));
  const EurocFlight source(flight, small_rig());
  ASSERT_EQ(source.frame_count(), 4);
  EXPECT_EQ(source.dropped().without_pose, 6);
  EXPECT_EQ(source.stamp(0).time_since_epoch().count(), stamp_ns(1));
  EXPECT_EQ(source.stamp(3).time_since_epoch().count(), stamp_ns(4));
  expect_point(source.T_map_body(1).translation(), {2.0, 0.0, 0.0});  // two thirds of the way
}

TEST(EurocFlightTest, WithoutGroundTruthThereAreImagesOnly) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  fs::create_directories(flight / "mav0/state_groundtruth_estimate0");
  const EurocFlight source(flight, small_rig());
  EXPECT_FALSE(source.has_poses());
  EXPECT_EQ(source.read(0).pairs[0].left.size(), kSize);
  EXPECT_THAT(message_of([&] { (void)source.T_map_body(0); }),
              HasSubstr("state_groundtruth_estimate0/data.csv: no such file"));
}

TEST(EurocFlightTest, TruthOfAnotherFlightIsRefused) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 2);
  write_truth(folder, truth_line(5, "0,0,0,1,0,0,0"));
  EXPECT_THAT(message_of([&] { const EurocFlight source(flight, small_rig()); }),
              HasSubstr("no pose for any of the 2"));
}

TEST(EurocFlightTest, WhatIsMissingIsNamed) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  const auto complaint = [&] {
    return message_of([&] { const EurocFlight source(flight, small_rig()); });
  };
  EXPECT_THAT(message_of([&] { const EurocFlight source(folder.path() / "none", small_rig()); }),
              HasSubstr("none: no such folder"));
  EXPECT_THAT(message_of([&] { const EurocFlight source(folder.path(), small_rig()); }),
              HasSubstr("is no EuRoC flight"));
  fs::remove(image_file(flight, 1, 0));
  EXPECT_THAT(complaint(), HasSubstr("mav0: has no image pair"));
  folder.write("flight/mav0/cam1/data.csv", "7,../../secret.png\n1403715273262142976,../x.png\n");
  EXPECT_THAT(complaint(), HasSubstr("cam1/data.csv:2: expected a file name"));
  fs::remove(flight / "mav0/cam1/data.csv");
  EXPECT_THAT(complaint(), HasSubstr("cam1/data.csv: no such file"));
  fs::remove_all(flight / "mav0/cam1");
  EXPECT_THAT(complaint(), HasSubstr("is no EuRoC flight"));
}

TEST(EurocFlightTest, AnImageOfAnotherSizeThanTheRigsIsNamed) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  const EurocFlight source(flight, rig_of(kSize, {48, 30}));
  EXPECT_THAT(message_of([&] { (void)source.read(0); }),
              HasSubstr(image_file(flight, 1, 0).string() + ": has 48x32 pixels, expected 48x30"));
  StereoRig rectified = small_rig();
  rectified.pairs[0].raw.reset();
  const EurocFlight other(flight, rectified);
  EXPECT_THAT(message_of([&] { (void)other.read(0); }), HasSubstr("expected 40x30"));
}

TEST(EurocFlightTest, TheRigHasOnePair) {
  const TempFolder folder;
  const fs::path flight = write_flight(folder, 1);
  StereoRig two = small_rig();
  two.pairs.push_back(two.pairs[0]);
  EXPECT_THAT(message_of([&] { const EurocFlight source(flight, two); }),
              HasSubstr("the rig has 2"));
  EXPECT_THAT(message_of([&] { const EurocFlight source(flight, {}); }),
              HasSubstr("the rig has 0"));
}

TEST(EurocFlightSystem, ARecordedFlightOpens) {
  const fs::path flight = testing::recorded_data() / "euroc_V1_01_flight";
  SKYHALO_SKIP_WITHOUT(flight);
  // The IMU of the VI-sensor has x up and z ahead.
  Eigen::Matrix3d R_body_imu;
  R_body_imu << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  const EurocFlight source(
      flight, rig_of({752, 480}, {752, 480}), make_pose(R_body_imu, Eigen::Vector3d::Zero()));
  ASSERT_EQ(source.frame_count(), 50);
  EXPECT_EQ(source.stamp(0).time_since_epoch().count(), 1403715273262142976);
  EXPECT_EQ(source.read(49).pairs[0].right.size(), cv::Size(752, 480));
  ASSERT_TRUE(source.has_poses());
  EXPECT_EQ(source.dropped().without_pose, 0);
  // It stands on the floor, level within 30 degrees, then rises; the room is 8 m wide.
  expect_point(source.T_map_body(0).translation(), {0.0, 0.0, 0.0});
  EXPECT_GT(source.T_map_body(0).linear()(2, 2), 0.85);
  double highest_m = 0.0;
  for (int frame = 0; frame < source.frame_count(); ++frame) {
    highest_m = std::max(highest_m, source.T_map_body(frame).translation().z());
    EXPECT_LT(source.T_map_body(frame).translation().norm(), 8.0);
  }
  EXPECT_GT(highest_m, 0.3);
}

TEST(EurocFlightSystem, AFlightWithFewOfItsImagesOpens) {
  const fs::path flight = testing::recorded_data() / "euroc_micro_V1_01";
  SKYHALO_SKIP_WITHOUT(flight);
  const EurocFlight source(flight, rig_of({752, 480}, {752, 480}));
  EXPECT_EQ(source.frame_count(), 4);
  EXPECT_GT(source.dropped().without_image, 50);
  EXPECT_FALSE(source.has_poses());
  EXPECT_EQ(source.read(3).pairs[0].left.size(), cv::Size(752, 480));
}

}  // namespace
}  // namespace skyhalo
