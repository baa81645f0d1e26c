#include "skyhalo/sim/simulated_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <opencv2/core.hpp>

#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"
#include "skyhalo/dataset/euroc_writer.hpp"
#include "skyhalo/dataset/flight_recording.hpp"
#include "skyhalo/dataset/flight_recording_writer.hpp"
#include "skyhalo/sim/make_scene.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"
#include "support/expect_error.hpp"
#include "support/sanitised.hpp"
#include "support/small_rigs.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;

RigDescription small_rig() {
  RigDescription rig = testing::rig_of({testing::pinhole_pair(), testing::fisheye_pair()});
  rig.pairs[1].line_time_s = 4e-5;
  return rig;
}

std::unique_ptr<SimulatedFlight> fly_yard(const SimulationConfig& config) {
  static const Scene kYard = make_scene({.name = "yard"});
  Scene scene = kYard;
  Trajectory trajectory = fly_waypoints(scene.route_m, {}, scene.route_closed);
  return std::make_unique<SimulatedFlight>(
      std::move(scene), std::move(trajectory), resolve(small_rig()), config);
}

SimulationConfig few_frames() {
  SimulationConfig config;
  config.frames = 2;
  config.look.samples = 1;
  return config;
}

void expect_same(const cv::Mat& a, const cv::Mat& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.type(), b.type());
  EXPECT_EQ(cv::norm(a, b, cv::NORM_L1), 0.0);
}

void expect_same(const FrameSet& a, const FrameSet& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    expect_same(a.pairs[i].left, b.pairs[i].left);
    expect_same(a.pairs[i].right, b.pairs[i].right);
  }
}

TEST(SimulatedFlightTest, TheSameSeedGivesTheSameFlightAtAnyNumberOfThreads) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  const auto first = fly_yard(few_frames());
  const FrameSet images = first->read(1);
  const std::vector<LaserReturn> scan = first->laser_returns(1);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto second = fly_yard(few_frames());
  expect_same(images, second->read(1));
  const std::vector<LaserReturn> again = second->laser_returns(1);
  ASSERT_EQ(scan.size(), again.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_EQ(scan[i].point_m, again[i].point_m);
  }
}

TEST(SimulatedFlightTest, AnotherSeedGivesOtherNoiseOnTheSameScene) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  SimulationConfig other = few_frames();
  other.seed = 2;
  const cv::Mat a = fly_yard(few_frames())->read_pair(0, 0).left;
  const cv::Mat b = fly_yard(other)->read_pair(0, 0).left;
  const double mean = cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * 3);
  EXPECT_GT(mean, 0.5);
  EXPECT_LT(mean, 8.0);
}

TEST(SimulatedFlightTest, RightCamerasAreDarkerByTheirGain) {
  const StereoImages images = fly_yard(few_frames())->read_pair(0, 0);
  const cv::Scalar left = cv::mean(images.left);
  const cv::Scalar right = cv::mean(images.right);
  EXPECT_NEAR(right[1] / left[1], 0.9, 0.03);
}

TEST(SimulatedFlightTest, WhatIsWrittenReadsBackToTheLastBit) {
  SimulationConfig config = few_frames();
  config.ins.position_sigma_m = 0.1;
  const auto flight = fly_yard(config);
  const testing::TempFolder folder;
  FlightRecordingWriter writer(folder.path() / "flight",
                               {.name = "yard",
                                .source = {},
                                .rig = small_rig(),
                                .T_body_laser = flight->config().T_body_laser,
                                .has_sonar = true,
                                .has_objects = true});
  for (int frame = 0; frame < flight->frame_count(); ++frame) {
    LaserReturns scan;
    for (const LaserReturn& one : flight->laser_returns(frame)) {
      scan.points_m.push_back(one.point_m);
      scan.reflectances.push_back(one.reflectance);
    }
    writer.add({.images = flight->read(frame),
                .T_map_body = flight->T_map_body(frame),
                .true_pose = flight->T_scene_body(frame),
                .scan = scan,
                .sonar_m = flight->sonar_m(frame),
                .objects = flight->objects(frame, Eigen::Vector3d::Zero())});
  }
  writer.finish();

  const FlightRecording read(folder.path() / "flight");
  ASSERT_EQ(read.frame_count(), 2);
  for (int frame = 0; frame < 2; ++frame) {
    expect_same(read.read(frame), flight->read(frame));
    EXPECT_EQ(read.T_map_body(frame).matrix(), flight->T_map_body(frame).matrix());
    EXPECT_EQ(read.true_pose(frame)->matrix(), flight->T_scene_body(frame).matrix());
    EXPECT_EQ(read.sonar_m(frame), flight->sonar_m(frame));
    const std::vector<LaserReturn> scan = flight->laser_returns(frame);
    const LaserScan again = *read.read_scan(frame);
    ASSERT_EQ(again.size(), scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      EXPECT_EQ(again[i], scan[i].point_m);
    }
    EXPECT_EQ(read.objects(frame).size(), flight->scene().movers.size());
  }
  EXPECT_GT((flight->T_map_body(0).translation() - flight->T_scene_body(0).translation()).norm(),
            0.001);
}

TEST(SimulatedFlightTest, AEurocFlightReadsBack) {
  const auto flight = fly_yard(few_frames());
  const testing::TempFolder folder;
  EurocWriter writer(folder.path() / "euroc", small_rig().pairs.front());
  for (int frame = 0; frame < 2; ++frame) {
    writer.add({flight->stamp(frame), flight->T_map_body(frame)}, flight->read_pair(frame, 0));
  }
  writer.finish();
  ImportOptions import;
  import.format = CalibrationFormat::kEuroc;
  const ImportResult rig = import_calibration({folder.path() / "euroc"}, import);
  const EurocFlight read(folder.path() / "euroc", resolve(rig.rig));
  ASSERT_EQ(read.frame_count(), 2);
  expect_same(read.read(1).pairs.front().left, flight->read_pair(1, 0).left);
  const Pose moved = read.T_map_body(0).inverse() * read.T_map_body(1);
  const Pose expected = flight->T_map_body(0).inverse() * flight->T_map_body(1);
  EXPECT_LT((moved.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(SimulatedFlightTest, SettingsThatCannotBeUsedAreNamed) {
  SimulationConfig config = few_frames();
  config.look.samples = 2;
  EXPECT_THAT(testing::message_of([&] { fly_yard(config); }), HasSubstr("samples"));
  config = few_frames();
  config.rate_hz = 0.0;
  EXPECT_THAT(testing::message_of([&] { fly_yard(config); }), HasSubstr("rate_hz"));
  config = few_frames();
  config.ins.delay_s = -1.0;
  EXPECT_THAT(testing::message_of([&] { fly_yard(config); }), HasSubstr("delay_s"));
}

}  // namespace
}  // namespace skyhalo
