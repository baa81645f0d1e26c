#include "skyhalo/dataset/kitti_tracking_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "skyhalo/calibration/key_value_file.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"
#include "skyhalo/dataset/kitti_tracking.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TempFolder;

const cv::Size kSize(320, 96);

KittiTrackingSetup setup() {
  return {resolve({.name = "", .T_body_imu = {}, .pairs = {testing::forward_pair()}}).pairs[0],
          testing::laser_place()};
}

SceneObject car_at(double x_m) {
  SceneObject object{.track = 4, .type = "Car"};
  object.size_m = {4.0, 2.0, 1.5};
  object.T_map_object = make_pose(Eigen::Matrix3d::Identity(), {x_m, 0.25, -1.125});
  return object;
}

/// A frame at the map's origin.
KittiTrackingFrame plain_frame(unsigned seed = 1) {
  return {.images = testing::textured_images(kSize, seed), .scan = testing::some_scan(seed)};
}

Eigen::Matrix4d matrix_of(const KeyValueFile& file, const std::string& key, int rows, int columns) {
  const auto values = file.numbers(key, static_cast<std::size_t>(rows * columns));
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      matrix(row, column) = values[static_cast<std::size_t>(row * columns + column)];
    }
  }
  return matrix;
}

TEST(KittiTrackingWriterTest, TheFilesAreNamedAsKittiNamesThem) {
  const TempFolder folder;
  KittiTrackingWriter writer(folder.path() / "out", 7, setup());
  KittiTrackingFrame frame = plain_frame();
  writer.add(frame);
  frame.scan.reset();
  writer.add(frame);
  frame.scan = LaserReturns{};  // nothing shone back
  writer.add(frame);
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  writer.finish();
  const fs::path training = folder.path() / "out/training";
  for (const char* const name : {"image_02/0007/000000.png",
                                 "image_03/0007/000002.png",
                                 "velodyne/0007/000000.bin",
                                 "oxts/0007.txt",
                                 "label_02/0007.txt",
                                 "calib/0007.txt"}) {
    EXPECT_TRUE(fs::is_regular_file(training / name)) << name;
  }
  EXPECT_FALSE(fs::exists(training / "velodyne/0007/000001.bin"));
  EXPECT_FALSE(fs::exists(training / "velodyne/0007/000002.bin"));
  EXPECT_FALSE(fs::exists(training / "image_02/0007/000003.png"));
  EXPECT_EQ(fs::file_size(training / "velodyne/0007/000000.bin"), 20U * 16U);
}

TEST(KittiTrackingWriterTest, TheCalibrationProjectsAsWorkedOutByHand) {
  const TempFolder folder;
  KittiTrackingWriter writer(folder.path(), 0, setup());
  writer.add(plain_frame());
  writer.finish();
  const fs::path file = folder.path() / "training/calib/0000.txt";
  for (const char* const key : {"P0: ", "P1: ", "P2: ", "P3: ", "R_rect ", "Tr_velo_cam "}) {
    EXPECT_THAT(testing::text_in(file), HasSubstr(key));
  }
  EXPECT_THAT(testing::text_in(file), HasSubstr("\nTr_imu_velo 1.000000000000e+00 "));
  const KeyValueFile values(file);
  const Eigen::Matrix4d T_reference_laser =
      matrix_of(values, "R_rect", 3, 3) * matrix_of(values, "Tr_velo_cam", 3, 4);
  // This point of the scanner is (9.25, -0.75, -0.125) of the body: 8.25 m before the left camera,
  // which is at (1, 0.25, 0.375), 1 m to its right and 0.5 m below it.
  const Eigen::Vector4d p(8.5, -0.75, -0.625, 1.0);
  const Eigen::Vector4d left = matrix_of(values, "P2", 3, 4) * T_reference_laser * p;
  EXPECT_NEAR(left.x() / left.z(), 156.0 + 256.0 * 1.0 / 8.25, 1e-9);
  EXPECT_NEAR(left.y() / left.z(), 48.0 + 256.0 * 0.5 / 8.25, 1e-9);
  const Eigen::Vector4d right = matrix_of(values, "P3", 3, 4) * T_reference_laser * p;
  EXPECT_NEAR(right.x() / right.z(), 160.0 + 256.0 * 0.5 / 8.25, 1e-9);
  const Eigen::Vector4d in_laser =
      matrix_of(values, "Tr_imu_velo", 3, 4) * Eigen::Vector4d(9.25, -0.75, -0.125, 1.0);
  EXPECT_TRUE(in_laser.isApprox(p, 1e-12));
}

TEST(KittiTrackingWriterTest, LabelsAreInTheLeftCamerasFrame) {
  const TempFolder folder;
  KittiTrackingWriter writer(folder.path(), 0, setup());
  KittiTrackingFrame frame = plain_frame();
  frame.objects = {car_at(11.0), car_at(-11.0)};  // the second one is behind
  writer.add(frame);
  frame.objects = {};
  writer.add(frame);
  // Five metres ahead, turned left: the car is to the right and further on.
  frame.T_map_body = make_pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                               {-5.0, 0.0, 0.0});
  frame.objects = {car_at(11.0)};
  writer.add(frame);
  writer.finish();
  const fs::path file = folder.path() / "training/label_02/0000.txt";
  EXPECT_THAT(testing::text_in(file),
              ::testing::StartsWith(
                  "0 4 Car 1 0 -1.570796 124.000000 48.000000 188.000000 95.000000 1.500000 "
                  "2.000000 4.000000 0.000000 1.500000 10.000000 -1.570796\n2 4 Car "));
  const TrackLabels labels(file);
  EXPECT_EQ(labels.objects(0).size(), 1U);
  EXPECT_EQ(labels.objects(1).size(), 0U);
  ASSERT_EQ(labels.objects(2).size(), 1U);
  // Through the files' own frames the box must hold the car's middle.
  const KittiTrackingSequence sequence(folder.path(), "0000");
  const Pose T_annotation_map = sequence.T_annotation_laser() * sequence.T_body_laser().inverse() *
                                frame.T_map_body.inverse();
  EXPECT_TRUE(
      contains(labels.objects(2)[0].box, T_annotation_map * Eigen::Vector3d(11, 0.25, -0.4)));
  EXPECT_TRUE(
      contains(labels.objects(2)[0].box, T_annotation_map * Eigen::Vector3d(12.9, 1.2, 0.3)));
  EXPECT_FALSE(contains(labels.objects(2)[0].box, T_annotation_map * Eigen::Vector3d(13.1, 0, 0)));
}

TEST(KittiTrackingWriterTest, SeveralSequencesShareAFolder) {
  const TempFolder folder;
  for (const int number : {3, 1}) {
    KittiTrackingWriter writer(folder.path() / "out", number, setup());
    writer.add(plain_frame());
    writer.finish();
  }
  EXPECT_THAT(kitti_tracking_sequences(folder.path() / "out"),
              ::testing::ElementsAre("0001", "0003"));
  EXPECT_THAT(message_of([&] { const KittiTrackingWriter w(folder.path() / "out", 3, setup()); },
                         ErrorKind::kFailure),
              HasSubstr("calib/0003.txt"));
}

TEST(KittiTrackingWriterTest, WithoutFinishNothingStays) {
  const TempFolder folder;
  {
    KittiTrackingWriter writer(folder.path() / "out", 0, setup());
    writer.add(plain_frame());
  }
  EXPECT_THAT(fs::directory_iterator(folder.path()) == fs::directory_iterator(), true);
  KittiTrackingWriter writer(folder.path() / "out", 0, setup());
  EXPECT_THAT(message_of([&] { writer.finish(); }), HasSubstr("at least one frame"));
  writer.add(plain_frame());
  writer.finish();
  EXPECT_THAT(message_of([&] { writer.finish(); }, ErrorKind::kFailure), HasSubstr("is finished"));
}

TEST(KittiTrackingWriterTest, WhatDoesNotFitTheLayoutIsRefused) {
  const TempFolder folder;
  const auto refused = [&](const KittiTrackingSetup& bad, int sequence = 0) {
    return message_of([&] { const KittiTrackingWriter w(folder.path() / "out", sequence, bad); });
  };
  KittiTrackingSetup bad = setup();
  bad.pair.model = SphericalPair{0.01, 0.01, 10.0, 10.0, 0.5};
  EXPECT_THAT(refused(bad), HasSubstr("pair 'front': KITTI's layout is for rectified pinhole"));
  bad = setup();
  bad.pair.image_size_px = {};
  EXPECT_THAT(refused(bad), HasSubstr("image size"));
  bad = setup();
  bad.T_body_laser.linear() *= 2.0;
  EXPECT_THAT(refused(bad), HasSubstr("expected finite rigid transforms"));
  EXPECT_THAT(refused(setup(), -1), HasSubstr("0...9999, found -1"));
  EXPECT_THAT(refused(setup(), 10000), HasSubstr("0...9999"));

  KittiTrackingWriter writer(folder.path() / "out", 0, setup());
  const auto frame_refused = [&](const auto& change) {
    KittiTrackingFrame frame = plain_frame();
    change(frame);
    return message_of([&] { writer.add(frame); });
  };
  EXPECT_THAT(frame_refused([](auto& f) {
                f.images.right = testing::texture({319, 96}, 1);
              }),
              HasSubstr("frame 0: right image has 319x96 pixels, expected 320x96"));
  EXPECT_THAT(frame_refused([](auto& f) { f.images.left = cv::Mat1w(96, 320); }),
              HasSubstr("left image: expected a grey or BGR image of 8 bits"));
  EXPECT_THAT(frame_refused([](auto& f) {
                f.T_map_body.translation().x() = std::numeric_limits<double>::quiet_NaN();
              }),
              HasSubstr("frame 0: T_map_body: expected a finite rigid"));
  EXPECT_THAT(frame_refused([](auto& f) { f.T_map_body.linear() *= 1.1; }), HasSubstr("rigid"));
  EXPECT_THAT(frame_refused([](auto& f) {
                f.objects = {car_at(9.0)};
                f.objects[0].type = "Big car";
              }),
              HasSubstr("frame 0: object 4: expected a type of one word"));
  EXPECT_THAT(frame_refused([](auto& f) {
                f.scan->points_m[3].y() = std::numeric_limits<float>::infinity();
              }),
              HasSubstr("frame 0: scan: point 3 is not finite"));
  writer.add(plain_frame());  // goes on from frame 0
  writer.finish();
  EXPECT_EQ(KittiTrackingSequence(folder.path() / "out", "0000").frame_count(), 1);
}

TEST(KittiTrackingWriterProperty, WhatIsWrittenIsReadBack) {
  std::mt19937 random(8);
  const TempFolder folder;
  KittiTrackingWriter writer(folder.path(), 12, setup());
  std::vector<KittiTrackingFrame> frames;
  for (unsigned i = 0; i < 4; ++i) {
    frames.push_back(plain_frame(i));
    frames.back().T_map_body = testing::driving_pose(random, 500.0);
    writer.add(frames.back());
  }
  writer.finish();
  const KittiTrackingSequence sequence(folder.path(), "0012");
  ASSERT_EQ(sequence.frame_count(), 4);
  const StereoPair& pair = sequence.rig().pairs.at(0);
  EXPECT_EQ(pair.image_size_px, kSize);
  const auto& model = std::get<PinholePair>(pair.model);
  EXPECT_NEAR(model.focal_px, 256.0, 1e-9);
  EXPECT_NEAR(model.principal_u_px, 160.0, 1e-9);
  EXPECT_NEAR(model.principal_v_px, 48.0, 1e-9);
  EXPECT_NEAR(model.baseline_m, 0.5, 1e-12);
  EXPECT_NEAR(model.disparity_offset_px, 4.0, 1e-9);
  EXPECT_TRUE(pair.T_body_camera.isApprox(testing::forward_pair().T_body_camera, 1e-10));
  EXPECT_TRUE(sequence.T_body_laser().isApprox(testing::laser_place(), 1e-10));
  for (int i = 0; i < 4; ++i) {
    const KittiTrackingFrame& written = frames[static_cast<std::size_t>(i)];
    const FrameSet read = sequence.read(i);
    EXPECT_TRUE(testing::same_image(read.pairs.at(0).left, written.images.left));
    EXPECT_TRUE(testing::same_image(read.pairs.at(0).right, written.images.right));
    EXPECT_EQ(sequence.read_scan(i), written.scan->points_m);
    const auto d =
        testing::difference(frames[0].T_map_body * sequence.T_map_body(i), written.T_map_body);
    EXPECT_LT(d.distance_m, 1e-4);
    EXPECT_LT(d.angle_rad, 1e-7);
  }
}

}  // namespace
}  // namespace skyhalo
