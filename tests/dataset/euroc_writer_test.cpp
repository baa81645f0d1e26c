#include "skyhalo/dataset/euroc_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"
#include "skyhalo/dataset/euroc_table.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

const cv::Size kSize(64, 48);
constexpr std::int64_t kStartNs = 1403715273262142977;  // no double holds it
constexpr std::int64_t kStepNs = 50'000'000;

PairDescription raw_pair(const Lens& lens) {
  Pose T_right_left = Pose::Identity();
  T_right_left.translation() = Eigen::Vector3d(-0.11, 0.001, -0.002);
  T_right_left.linear() =
      Eigen::AngleAxisd(0.01, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  return {.name = "front",
          .images = RawPairDescription{{{kSize, lens}, {kSize, lens}, T_right_left}, {}},
          .T_body_camera = make_pose(testing::forward_camera(), {0.1, -0.05, 0.02})};
}

PairDescription radial_pair() {
  return raw_pair(RadialTangentialLens({40.0, 40.5, 31.0, 24.0}, {-0.02, 0.001, 1e-4, -2e-4}));
}

StampedPose pose_at(int frame, const Pose& T_map_body) {
  return {Timestamp(std::chrono::nanoseconds(kStartNs + frame * kStepNs)), T_map_body};
}

/// Writes so many frames of a pair and returns their poses.
std::vector<StampedPose> write_flight(const fs::path& folder,
                                      const PairDescription& pair,
                                      int frames,
                                      const cv::Size& size = kSize) {
  std::mt19937 random(11);
  EurocWriter writer(folder, pair);
  std::vector<StampedPose> poses;
  for (int i = 0; i < frames; ++i) {
    poses.push_back(pose_at(i, testing::some_pose(random, 20.0)));
    writer.add(poses.back(), testing::textured_images(size, static_cast<unsigned>(i)));
  }
  writer.finish();
  return poses;
}

RigDescription import(const fs::path& folder) {
  ImportOptions options;
  options.format = CalibrationFormat::kEuroc;
  return import_calibration({folder}, options).rig;
}

void expect_same_pair(const RawPairDescription& a, const RawPairDescription& b) {
  for (const auto& [x, y] : {std::pair(&a.cameras.left, &b.cameras.left),
                             std::pair(&a.cameras.right, &b.cameras.right)}) {
    EXPECT_EQ(x->size_px, y->size_px);
    EXPECT_EQ(x->lens.index(), y->lens.index());
    for (const Eigen::Vector3d& ray :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, -0.2, 1), Eigen::Vector3d(-0.4, 0.1, 1)}) {
      EXPECT_EQ(project(x->lens, ray), project(y->lens, ray));
    }
  }
  EXPECT_TRUE(a.cameras.T_right_left.isApprox(b.cameras.T_right_left, 1e-12));
}

TEST(EurocWriterProperty, CamerasPosesAndImagesComeBack) {
  for (const PairDescription& pair :
       {radial_pair(),
        raw_pair(RadialTangentialLens({40.0, 40.5, 31.0, 24.0},
                                      {-0.02, 0.001, 1e-4, -2e-4, 1e-3, 1e-4, 1e-4, 1e-5})),
        raw_pair(KannalaBrandtLens({40.0, 40.0, 31.0, 24.0}, {0.01, -0.002, 0.001, 1e-4}))}) {
    const TempFolder folder;
    const std::vector<StampedPose> poses = write_flight(folder.path() / "flight", pair, 4);
    const RigDescription rig = import(folder.path() / "flight");
    ASSERT_EQ(rig.pairs.size(), 1U);
    expect_same_pair(std::get<RawPairDescription>(rig.pairs[0].images),
                     std::get<RawPairDescription>(pair.images));
    const Pose T_body_imu = rig.T_body_imu.value_or(Pose::Identity());
    EXPECT_TRUE(
        (T_body_imu.inverse() * rig.pairs[0].T_body_camera).isApprox(pair.T_body_camera, 1e-12));
    const EurocFlight flight(folder.path() / "flight", resolve(rig), T_body_imu);
    ASSERT_EQ(flight.frame_count(), 4);
    EXPECT_EQ(flight.name(), "flight");
    for (int i = 0; i < 4; ++i) {
      const StampedPose& written = poses[static_cast<std::size_t>(i)];
      EXPECT_EQ(flight.stamp(i), written.stamp);
      const Pose relative = T_body_imu.inverse() *
                            (flight.T_map_body(0).inverse() * flight.T_map_body(i)) * T_body_imu;
      const Pose expected = poses[0].T_map_body.inverse() * written.T_map_body;
      EXPECT_LT((relative.matrix() - expected.matrix()).norm(), 1e-9);
      const StereoImages read = flight.read(i).pairs.at(0);
      const StereoImages images = testing::textured_images(kSize, static_cast<unsigned>(i));
      EXPECT_TRUE(testing::same_image(read.left, images.left));
      EXPECT_TRUE(testing::same_image(read.right, images.right));
    }
  }
}

TEST(EurocWriterTest, ARectifiedPairIsTwoCamerasWithoutDistortion) {
  const TempFolder folder;
  write_flight(folder.path() / "flight", testing::forward_pair(), 1, {320, 96});
  const RigDescription rig = import(folder.path() / "flight");
  const auto& pair = std::get<RawPairDescription>(rig.pairs.at(0).images);
  EXPECT_EQ(intrinsics(pair.cameras.left.lens).cx_px, 156.0);
  EXPECT_EQ(intrinsics(pair.cameras.right.lens).cx_px, 160.0);
  EXPECT_TRUE(pair.cameras.T_right_left.translation().isApprox(Eigen::Vector3d(-0.5, 0, 0), 1e-12));
}

TEST(EurocWriterTest, TheTruthHasSeventeenColumnsWithVelocities) {
  const TempFolder folder;
  EurocWriter writer(folder.path() / "flight", radial_pair());
  for (int i = 0; i < 3; ++i) {
    const Pose T = make_pose(Eigen::Matrix3d::Identity(), {0.1 * i, 0.0, 0.05 * i * i});
    writer.add(pose_at(i, T), testing::textured_images(kSize, 1));
  }
  writer.finish();
  const auto rows =
      read_euroc_table(folder.path() / "flight/mav0/state_groundtruth_estimate0/data.csv", 16);
  ASSERT_EQ(rows.size(), 3U);
  const auto number = [&](std::size_t row, std::size_t field) {
    return parse_number(rows[row].fields[field]).value();
  };
  EXPECT_EQ(number(1, 0), 0.1);
  EXPECT_EQ(number(1, 3), 1.0);          // w of the quaternion
  EXPECT_NEAR(number(1, 7), 2.0, 1e-9);  // 0.2 m in 0.1 s
  EXPECT_NEAR(number(1, 9), 2.0, 1e-9);  // 0.2 m in 0.1 s
  EXPECT_NEAR(number(0, 9), 1.0, 1e-9);  // 0.05 m in 0.05 s
  for (std::size_t field = 10; field < 16; ++field) {
    EXPECT_EQ(rows[1].fields[field], "0");
  }
  const std::string sensor = testing::text_in(folder.path() / "flight/mav0/cam0/sensor.yaml");
  EXPECT_THAT(sensor, HasSubstr("rate_hz: 20\n"));
  EXPECT_THAT(sensor, HasSubstr("resolution: [64, 48]"));
  EXPECT_THAT(testing::text_in(folder.path() / "flight/mav0/cam1/data.csv"),
              HasSubstr("#timestamp [ns],filename\n1403715273262142977,1403715273262142977.png\n"));
  EXPECT_FALSE(fs::exists(folder.path() / "flight/mav0/imu0"));
}

TEST(EurocWriterTest, WhatTheLayoutCannotHoldIsRefused) {
  const TempFolder folder;
  const auto refused = [&](const PairDescription& pair) {
    return message_of([&] { const EurocWriter w(folder.path() / "flight", pair); });
  };
  EXPECT_THAT(refused(raw_pair(DoubleSphereLens({40.0, 40.0, 31.0, 24.0}, {0.0, 0.5}))),
              HasSubstr("lens: EuRoC's layout is for radial-tangential"));
  PairDescription spherical = testing::forward_pair();
  spherical.images = RectifiedPairDescription{kSize, SphericalPair{0.01, 0.01, 10, 10, 0.5}};
  EXPECT_THAT(refused(spherical), HasSubstr("pair 'front': EuRoC's layout is for raw or pinhole"));

  EurocWriter writer(folder.path() / "flight", radial_pair());
  EXPECT_THAT(message_of([&] { writer.finish(); }), HasSubstr("at least one frame"));
  writer.add(pose_at(1, Pose::Identity()), testing::textured_images(kSize, 1));
  EXPECT_THAT(message_of([&] {
                writer.add(pose_at(1, Pose::Identity()), testing::textured_images(kSize, 1));
              }),
              HasSubstr("frame 1: stamp: expected one after"));
  EXPECT_THAT(message_of([&] {
                writer.add(pose_at(2, Pose::Identity()), testing::textured_images({8, 8}, 1));
              }),
              HasSubstr("frame 1: left image has 8x8 pixels, expected 64x48"));
  writer.finish();
  EXPECT_THAT(message_of([&] { const EurocWriter w(folder.path() / "flight", radial_pair()); },
                         ErrorKind::kFailure),
              HasSubstr("something is there already"));
}

TEST(EurocWriterTest, WithoutFinishNothingStays) {
  const TempFolder folder;
  {
    EurocWriter writer(folder.path() / "flight", radial_pair());
    writer.add(pose_at(1, Pose::Identity()), testing::textured_images(kSize, 1));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace skyhalo
