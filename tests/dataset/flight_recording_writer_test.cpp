#include "skyhalo/dataset/flight_recording_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skyhalo/dataset/flight_recording.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/written_flight.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::bare_frame;
using testing::full_flight;
using testing::full_frame;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

bool same_values(const cv::Mat1f& a, const cv::Mat1f& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

void expect_same_frame(const FlightRecording& flight, int i, const FlightFrame& written) {
  EXPECT_EQ(flight.stamp(i), written.images.stamp);
  EXPECT_EQ(flight.T_map_body(i).matrix(), written.T_map_body.matrix());
  EXPECT_EQ(flight.true_pose(i)->matrix(), written.true_pose->matrix());
  const FrameSet read = flight.read(i);
  EXPECT_EQ(read.stamp, written.images.stamp);
  for (const std::size_t pair : {0U, 1U}) {
    EXPECT_TRUE(testing::same_image(read.pairs.at(pair).left, written.images.pairs[pair].left));
    EXPECT_TRUE(testing::same_image(read.pairs.at(pair).right, written.images.pairs[pair].right));
  }
  EXPECT_EQ(flight.read_scan(i), written.scan->points_m);
  EXPECT_EQ(flight.sonar_m(i), written.sonar_m);
  EXPECT_TRUE(same_values(flight.true_disparity_px(i, 0), written.truth[0].disparity_px));
  EXPECT_TRUE(same_values(flight.true_range_m(i, 0), written.truth[0].range_m));
  EXPECT_TRUE(flight.true_disparity_px(i, 1).empty());
  EXPECT_TRUE(flight.true_range_m(i, 1).empty());
  ASSERT_EQ(flight.objects(i).size(), 1U);
  const SceneObject& object = flight.objects(i)[0];
  EXPECT_EQ(object.track, 4);
  EXPECT_EQ(object.type, "Car");
  EXPECT_EQ(object.size_m, written.objects[0].size_m);
  EXPECT_EQ(object.occluded, written.objects[0].occluded);
  EXPECT_EQ(object.T_map_object.translation(), written.objects[0].T_map_object.translation());
  EXPECT_TRUE(object.T_map_object.isApprox(written.objects[0].T_map_object, 1e-14));
}

TEST(FlightRecordingWriterProperty, EverythingReadsBackToTheLastBit) {
  const TempFolder folder;
  testing::write_flight(folder.path() / "flight", 3);
  const FlightRecording flight(folder.path() / "flight");
  EXPECT_EQ(flight.name(), "test flight");
  EXPECT_EQ(flight.source(), full_flight().source);
  ASSERT_EQ(flight.frame_count(), 3);
  EXPECT_EQ(flight.T_body_laser().matrix(), testing::laser_place().matrix());
  const StereoRig rig = resolve(testing::two_pairs());
  ASSERT_EQ(flight.rig().pairs.size(), 2U);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(flight.rig().pairs[i].name, rig.pairs[i].name);
    EXPECT_EQ(flight.rig().pairs[i].T_body_camera.matrix(), rig.pairs[i].T_body_camera.matrix());
  }
  for (int i = 0; i < 3; ++i) {
    expect_same_frame(flight, i, full_frame(static_cast<unsigned>(i)));
  }
}

TEST(FlightRecordingWriterTest, SixteenBitsAndColourAreKept) {
  const TempFolder folder;
  FlightFrame frame = bare_frame(0);
  cv::Mat3b colour(testing::kRectifiedSize);
  cv::randu(colour, 0, 256);
  cv::Mat1w deep(testing::kRectifiedSize);
  cv::randu(deep, 0, 65536);
  frame.images.pairs[0] = {colour, deep};
  {
    FlightRecordingWriter writer(folder.path() / "flight", full_flight());
    writer.add(frame);
    writer.finish();
  }
  const FrameSet read = FlightRecording(folder.path() / "flight").read(0);
  EXPECT_TRUE(testing::same_image(read.pairs.at(0).left, colour));
  EXPECT_TRUE(testing::same_image(read.pairs.at(0).right, deep));
}

TEST(FlightRecordingWriterTest, OnlyImagesAndPosesAreNeeded) {
  const TempFolder folder;
  FlightDescription description = full_flight();
  description.T_body_laser.reset();
  description.has_sonar = false;
  description.has_objects = false;
  FlightRecordingWriter writer(folder.path() / "flight", description);
  writer.add(bare_frame(0));
  writer.finish();
  const FlightRecording flight(folder.path() / "flight");
  EXPECT_FALSE(flight.has_laser());
  EXPECT_FALSE(flight.has_sonar());
  EXPECT_FALSE(flight.has_objects());
  EXPECT_FALSE(flight.read_scan(0));
  EXPECT_FALSE(flight.sonar_m(0));
  EXPECT_FALSE(flight.true_pose(0));
  EXPECT_TRUE(flight.objects(0).empty());
  EXPECT_TRUE(flight.boxes_in_body(0).empty());
  for (const char* const name : {"poses_true.txt", "sonar.csv", "objects.csv", "laser", "truth"}) {
    EXPECT_FALSE(fs::exists(folder.path() / "flight" / name)) << name;
  }
  EXPECT_THAT(message_of([&] { (void)flight.T_body_laser(); }),
              HasSubstr("flight.json: laser: this key is missing"));
}

TEST(FlightRecordingWriterTest, ThatNothingMovesIsKept) {
  const TempFolder folder;
  FlightRecordingWriter writer(folder.path() / "flight", full_flight());
  writer.add(bare_frame(0));
  writer.finish();
  const FlightRecording flight(folder.path() / "flight");
  EXPECT_TRUE(flight.has_objects());
  EXPECT_TRUE(flight.objects(0).empty());
}

TEST(FlightRecordingWriterTest, NoEchoAndNoPointAreKept) {
  const TempFolder folder;
  FlightRecordingWriter writer(folder.path() / "flight", full_flight());
  FlightFrame frame = bare_frame(0);
  writer.add(frame);
  frame = bare_frame(1);
  frame.scan = LaserReturns{};
  frame.sonar_m = 0.0;
  writer.add(frame);
  writer.finish();
  EXPECT_EQ(testing::text_in(folder.path() / "flight/sonar.csv"),
            "frame,stamp_ns,range_m\n0,1700000000000000001,\n1,1700000000000000004,0\n");
  const FlightRecording flight(folder.path() / "flight");
  EXPECT_EQ(flight.sonar_m(0), std::nullopt);
  EXPECT_EQ(flight.sonar_m(1), 0.0);
  EXPECT_EQ(flight.read_scan(0), std::nullopt);
  EXPECT_EQ(flight.read_scan(1), LaserScan{});
}

TEST(FlightRecordingWriterTest, WhatDoesNotFitTheDescriptionIsRefused) {
  const TempFolder folder;
  FlightDescription description = full_flight();
  description.T_body_laser.reset();
  description.has_sonar = false;
  description.has_objects = false;
  FlightRecordingWriter writer(folder.path() / "flight", description);
  writer.add(bare_frame(1));
  const auto refused = [&](const auto& change) {
    FlightFrame frame = bare_frame(2);
    change(frame);
    return message_of([&] { writer.add(frame); });
  };
  EXPECT_THAT(refused([](auto& f) { f.images.stamp = bare_frame(1).images.stamp; }),
              HasSubstr("frame 1: stamp: expected one after"));
  EXPECT_THAT(refused([](auto& f) { f.images.pairs.pop_back(); }),
              HasSubstr("frame 1: expected images, and truth if any, of 2 pairs"));
  EXPECT_THAT(refused([](auto& f) { f.truth.resize(1); }), HasSubstr("of 2 pairs"));
  EXPECT_THAT(refused([](auto& f) { std::swap(f.images.pairs[0], f.images.pairs[1]); }),
              HasSubstr("frame 1: front left image has 64x48 pixels, expected 320x96"));
  EXPECT_THAT(refused([](auto& f) { f.true_pose = Pose::Identity(); }),
              HasSubstr("frame 1: true_pose: expected in all frames or in none"));
  EXPECT_THAT(refused([](auto& f) { f.T_map_body.linear() *= 2.0; }), HasSubstr("T_map_body: exp"));
  EXPECT_THAT(refused([](auto& f) { f.scan = testing::some_scan(1); }), HasSubstr("T_body_laser"));
  EXPECT_THAT(refused([](auto& f) { f.sonar_m = 1.0; }), HasSubstr("no sonar"));
  EXPECT_THAT(refused([](auto& f) {
                f.objects = {testing::upright_object(-2, Eigen::Vector3d::Zero(), 0.0)};
              }),
              HasSubstr("frame 1: object -2"));
  EXPECT_THAT(refused([](auto& f) {
                f.objects = {testing::upright_object(2, Eigen::Vector3d::Zero(), 0.0)};
              }),
              HasSubstr("frame 1: has objects, but the description none"));
  EXPECT_THAT(refused([](auto& f) {
                f.truth = {{cv::Mat1f(97, 320, 1.0F), {}}, {}};
              }),
              HasSubstr("frame 1: front truth: expected an image no larger"));
  writer.finish();
  EXPECT_EQ(FlightRecording(folder.path() / "flight").frame_count(), 1);
}

TEST(FlightRecordingWriterTest, ADescriptionThatCannotBeUsedIsRefused) {
  const TempFolder folder;
  const auto refused = [&](const auto& change) {
    FlightDescription description = full_flight();
    change(description);
    return message_of([&] { const FlightRecordingWriter w(folder.path() / "out", description); });
  };
  EXPECT_THAT(refused([](auto& d) { d.name = ""; }), HasSubstr("expected a name"));
  EXPECT_THAT(refused([](auto& d) { d.T_body_laser->linear() *= 2.0; }), HasSubstr("T_body_laser"));
  EXPECT_THAT(refused([](auto& d) { d.rig.pairs[0].name = "../x"; }), HasSubstr("pairs[0].name"));
  EXPECT_THAT(refused([](auto& d) { d.rig.pairs[0].name = "rear"; }), HasSubstr("another pair"));
  EXPECT_THAT(refused([](auto& d) { d.rig.pairs.clear(); }), HasSubstr("pairs"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FlightRecordingWriterTest, TheRecordingAppearsWholeOrNotAtAll) {
  const TempFolder folder;
  {
    FlightRecordingWriter writer(folder.path() / "flight", full_flight());
    writer.add(full_frame(0));
    EXPECT_FALSE(fs::exists(folder.path() / "flight"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  FlightRecordingWriter writer(folder.path() / "flight", full_flight());
  EXPECT_THAT(message_of([&] { writer.finish(); }), HasSubstr("at least one frame"));
  writer.add(full_frame(0));
  writer.finish();
  EXPECT_THAT(message_of([&] { writer.add(full_frame(1)); }, ErrorKind::kFailure),
              HasSubstr("is finished"));
  EXPECT_THAT(
      message_of([&] { const FlightRecordingWriter w(folder.path() / "flight", full_flight()); },
                 ErrorKind::kFailure),
      HasSubstr("something is there already"));
}

}  // namespace
}  // namespace skyhalo
