#include "skyhalo/pipeline/obstacle_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "support/expect_error.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

const cv::Size kImageSize(320, 240);
constexpr double kPlaneM = 5.25;  // f B / d = 210 * 0.5 / 20

/// A camera in the body origin that looks along the body's x, turned to the left by `yaw_rad`.
Pose turned_camera(double yaw_rad) {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1,  //
      -1, 0, 0,              //
      0, -1, 0;
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  return make_pose(turn.toRotationMatrix() * R_body_camera, Eigen::Vector3d::Zero());
}

StereoPair pair_of_rig(const std::string& name, double yaw_deg) {
  StereoPair pair;
  pair.name = name;
  pair.image_size_px = kImageSize;
  pair.model = PinholePair{.focal_px = 210.0,
                           .principal_u_px = 159.5,
                           .principal_v_px = 119.5,
                           .baseline_m = 0.5,
                           .disparity_offset_px = 0.0};
  pair.T_body_camera = turned_camera(rad_from_deg(yaw_deg));
  return pair;
}

StereoRig front_rig() {
  return {{pair_of_rig("front", 0.0)}};
}

StereoRig two_pair_rig() {
  return {{pair_of_rig("front", 0.0), pair_of_rig("left", 90.0)}};
}

/// Matched at half the size: 160 x 120 pixels, disparities up to 32.
DetectorConfig small_config() {
  DetectorConfig config;
  config.matching.downscale = 2;
  config.matching.rcrop_px = 32;
  config.matching.matcher.max_disparity_px = 32;
  config.sphere.bounds.phi_min_rad = rad_from_deg(-180.0);
  config.sphere.bounds.phi_max_rad = rad_from_deg(180.0);
  // At 5.25 m delta_z is 27.6 * 0.1 / (0.5 * 105) = 0.0525 m: cells 0.25 m from the plane keep out
  // of its peak.
  config.sensor_model.delta_d_px = 0.1;
  return config;
}

VoxelGrid map_grid() {
  return make_voxel_grid({Eigen::Vector3d(-2.0, -6.0, -4.0), Eigen::Vector3d(10.0, 8.0, 4.0)}, 0.5);
}

FrameSet frames_of(std::size_t pairs, int disparity_px, unsigned seed) {
  FrameSet frames;
  for (std::size_t i = 0; i < pairs; ++i) {
    const auto [left, right] =
        testing::textured_pair(kImageSize, disparity_px, seed + static_cast<unsigned>(i));
    frames.pairs.push_back({left, right});
  }
  return frames;
}

std::vector<LogOdds> cells_of(const ObstacleDetector& detector) {
  return {detector.dense_map().cells().begin(), detector.dense_map().cells().end()};
}

bool is_occupied(LogOdds cell) {
  return probability_of(cell) > 0.7;
}

TEST(ObstacleDetectorTest, OccupiedCellsLieAtThePlane) {
  ObstacleDetector detector(front_rig(), small_config(), map_grid());
  detector.process(frames_of(1, 20, 1), Pose::Identity());
  const VoxelGrid& grid = detector.dense_map().grid();
  int at_plane = 0;
  int elsewhere = 0;
  for (std::int64_t offset = 0; offset < grid.cell_count(); ++offset) {
    if (is_occupied(detector.dense_map().cells()[static_cast<std::size_t>(offset)])) {
      // The cells that hold the plane: x in [5.0, 5.5), centre 5.25.
      const bool holds_plane = grid.cell_at(offset).x() == grid.cell_of({kPlaneM, 0.0, 0.0}).x();
      (holds_plane ? at_plane : elsewhere) += 1;
    }
  }
  EXPECT_GT(at_plane, 80);
  // A pixel in a corner of the image may go astray.
  EXPECT_LE(elsewhere * 50, at_plane);
}

void expect_seen(const DenseMap& map, const Eigen::Vector3d& on_plane_m) {
  EXPECT_TRUE(is_occupied(map.at_point(on_plane_m))) << on_plane_m.transpose();
  EXPECT_LT(map.at_point(0.5 * on_plane_m), 0) << on_plane_m.transpose();
  EXPECT_EQ(map.at_point(on_plane_m + 2.0 * Eigen::Vector3d::UnitX()), kUnknown);
}

TEST(ObstacleDetectorTest, TheSeenPartOfThePlaneIsOccupiedAndTheWayToItFree) {
  ObstacleDetector detector(front_rig(), small_config(), map_grid());
  detector.process(frames_of(1, 20, 2), Pose::Identity());
  // Matched columns 0...127 at f 105: y from -2.4 m to 4 m, z from -3 to 3 m on the plane.
  for (int y = 0; y < 10; ++y) {
    for (int z = 0; z < 8; ++z) {
      expect_seen(detector.dense_map(), {kPlaneM, 0.5 * y - 1.75, 0.5 * z - 1.75});
    }
  }
}

TEST(ObstacleDetectorTest, ThePoseTakesThePlaneToTheMap) {
  // Turned to the left by 90 deg and standing at (2, 1, 0): the plane is y = 1 + 5.25.
  ObstacleDetector detector(front_rig(), small_config(), map_grid());
  const Eigen::AngleAxisd turn(rad_from_deg(90.0), Eigen::Vector3d::UnitZ());
  detector.process(frames_of(1, 20, 3), make_pose(turn.toRotationMatrix(), {2.0, 1.0, 0.0}));
  EXPECT_TRUE(is_occupied(detector.dense_map().at_point({2.2, 6.25, 0.2})));
  EXPECT_TRUE(is_occupied(detector.dense_map().at_point({1.2, 6.25, -1.2})));
  EXPECT_LT(detector.dense_map().at_point({2.2, 4.25, 0.2}), 0);
  EXPECT_EQ(detector.dense_map().at_point({5.25, 0.2, 0.2}), kUnknown);
}

TEST(ObstacleDetectorTest, EveryPairSeesItsSide) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  detector.process(frames_of(2, 20, 4), Pose::Identity());
  EXPECT_TRUE(is_occupied(detector.dense_map().at_point({kPlaneM, 0.2, 0.2})));
  EXPECT_TRUE(is_occupied(detector.dense_map().at_point({0.2, kPlaneM, 0.2})));
  EXPECT_EQ(detector.dense_map().at_point({0.2, -kPlaneM, 0.2}), kUnknown);
}

TEST(ObstacleDetectorTest, TellsWhatAPairSaw) {
  ObstacleDetector detector(front_rig(), small_config(), map_grid());
  detector.process(frames_of(1, 20, 5), Pose::Identity());
  const PairPerception& seen = detector.perception(0);
  ASSERT_EQ(seen.disparity.size(), cv::Size(160, 120));
  EXPECT_NEAR(seen.disparity(60, 64), 10.0F, 0.25F);
  EXPECT_GT(seen.pixels.measured, 128 * 120 * 9 / 10);
  EXPECT_LE(seen.pixels.measured, 128 * 120);
  EXPECT_EQ(seen.pixels.used, seen.pixels.measured);
  EXPECT_LE(detector.integration().things, seen.grid.occupied_cell_count());
  EXPECT_GT(detector.integration().things, 1000);
  EXPECT_NEAR(seen.grid.rule().min_range_m, 105.0 * 0.5 / 32.0, 1e-12);
  EXPECT_ANY_THROW((void)detector.perception(1));
}

TEST(ObstacleDetectorTest, TheGridHoldsOnlyTheLastFrame) {
  ObstacleDetector detector(front_rig(), small_config(), map_grid());
  detector.process(frames_of(1, 20, 6), Pose::Identity());
  detector.process(frames_of(1, 30, 7), Pose::Identity());  // 210 * 0.5 / 30 = 3.5 m
  const SphericalGrid& grid = detector.perception(0).grid;
  const std::optional<GridCell> cell =
      grid.geometry().cell_of(rad_from_deg(90.5), rad_from_deg(0.5));
  ASSERT_TRUE(cell.has_value());
  const std::optional<CellStatistics> ahead = grid.statistics(*cell);
  ASSERT_TRUE(ahead.has_value());
  EXPECT_NEAR(ahead->mean_m, 3.5, 0.1);
  EXPECT_LT(ahead->sigma_m, 0.1);
}

TEST(ObstacleDetectorTest, MaskedPixelsAreNotSeen) {
  StereoRig rig = front_rig();
  rig.pairs[0].masks_px = {cv::Rect(0, 0, 320, 121)};  // the upper half, and one row more
  ObstacleDetector detector(rig, small_config(), map_grid());
  detector.process(frames_of(1, 20, 8), Pose::Identity());
  const cv::Mat1f& disparity = detector.perception(0).disparity;
  EXPECT_EQ(cv::countNonZero(disparity.rowRange(0, 61) == disparity.rowRange(0, 61)), 0);
  EXPECT_GT(cv::countNonZero(disparity == disparity), 128 * 59 / 2);
  EXPECT_EQ(detector.dense_map().at_point({kPlaneM, 0.2, 1.2}), kUnknown);
  EXPECT_TRUE(is_occupied(detector.dense_map().at_point({kPlaneM, 0.2, -1.2})));
}

TEST(ObstacleDetectorTest, MovesWithItsEngines) {
  ObstacleDetector first(front_rig(), small_config(), map_grid());
  ObstacleDetector second = std::move(first);
  second.process(frames_of(1, 20, 9), Pose::Identity());
  EXPECT_TRUE(is_occupied(second.dense_map().at_point({kPlaneM, 0.2, 0.2})));
}

struct Result {
  std::vector<LogOdds> cells;
  std::vector<cv::Mat1f> disparities;
};

Result run_with_threads(std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  for (unsigned frame = 0; frame < 3; ++frame) {
    detector.process(frames_of(2, 18 + static_cast<int>(frame), 10 * frame), Pose::Identity());
  }
  return {cells_of(detector),
          {detector.perception(0).disparity.clone(), detector.perception(1).disparity.clone()}};
}

/// Bit by bit, since NaN equals nothing.
bool is_same(const cv::Mat1f& a, const cv::Mat1f& b) {
  return a.size() == b.size() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(ObstacleDetectorProperty, OneAndTwoThreadsGiveTheSameBits) {
  const Result one = run_with_threads(1);
  const Result two = run_with_threads(2);
  EXPECT_EQ(one.cells, two.cells);
  EXPECT_GT(std::count_if(one.cells.begin(), one.cells.end(), is_occupied), 100);
  EXPECT_TRUE(is_same(one.disparities[0], two.disparities[0]));
  EXPECT_TRUE(is_same(one.disparities[1], two.disparities[1]));
}

/// A detector that has seen a frame, and its map then.
struct SeenOnce {
  ObstacleDetector detector{two_pair_rig(), small_config(), map_grid()};
  std::vector<LogOdds> before;

  SeenOnce() {
    detector.process(frames_of(2, 20, 30), Pose::Identity());
    before = cells_of(detector);
  }

  std::string refusal(const FrameSet& frames) {
    return message_of([&] { detector.process(frames, Pose::Identity()); });
  }
};

TEST(ObstacleDetectorTest, RefusesAnotherNumberOfPairsAndKeepsTheMap) {
  SeenOnce seen;
  EXPECT_THAT(seen.refusal(frames_of(1, 20, 31)), HasSubstr("1 pairs of images for a rig of 2"));
  EXPECT_THAT(seen.refusal(frames_of(3, 20, 31)), HasSubstr("frame set"));
  EXPECT_THAT(seen.refusal({}), HasSubstr("frame set"));
  EXPECT_EQ(cells_of(seen.detector), seen.before);
}

TEST(ObstacleDetectorTest, RefusesImagesOfAnotherSizeAndKeepsTheMap) {
  SeenOnce seen;
  FrameSet frames = frames_of(2, 20, 32);
  frames.pairs[1].left = testing::texture({322, 240}, 1);
  EXPECT_THAT(seen.refusal(frames), HasSubstr("pair left"));
  frames = frames_of(2, 20, 32);
  frames.pairs[0].right = testing::texture({320, 238}, 1);
  EXPECT_THAT(seen.refusal(frames), HasSubstr("pair front"));
  frames = frames_of(2, 20, 32);
  frames.pairs[1].left = cv::Mat();  // half a pair is none that does not deliver
  EXPECT_THAT(seen.refusal(frames), HasSubstr("pair left"));
  EXPECT_EQ(cells_of(seen.detector), seen.before);
}

TEST(ObstacleDetectorTest, RefusesImagesOfAnotherKindAndKeepsTheMap) {
  SeenOnce seen;
  FrameSet frames = frames_of(2, 20, 33);
  frames.pairs[1].right = cv::Mat(kImageSize, CV_32FC1, cv::Scalar(1.0));
  EXPECT_THAT(seen.refusal(frames), HasSubstr("8 or 16 bit"));
  EXPECT_EQ(cells_of(seen.detector), seen.before);
}

TEST(ObstacleDetectorTest, WorksOnAfterAnError) {
  SeenOnce seen;
  (void)seen.refusal({});
  seen.detector.process(frames_of(2, 20, 34), Pose::Identity());
  EXPECT_NE(cells_of(seen.detector), seen.before);
}

TEST(ObstacleDetectorTest, RefusesARigWithoutPairs) {
  EXPECT_THAT(message_of([] { ObstacleDetector({}, small_config(), map_grid()); }),
              HasSubstr("rig"));
}

TEST(ObstacleDetectorTest, RefusesSettingsOutsideTheirDomain) {
  DetectorConfig downscale = small_config();
  downscale.matching.downscale = 0;
  EXPECT_THAT(message_of([&] { ObstacleDetector(front_rig(), downscale, map_grid()); }),
              HasSubstr("matching.downscale"));
  DetectorConfig matcher = small_config();
  matcher.matching.matcher.opencv.paths = 4;
  EXPECT_THAT(message_of([&] { ObstacleDetector(front_rig(), matcher, map_grid()); }),
              HasSubstr("opencv.paths"));
  DetectorConfig model = small_config();
  model.sensor_model.p_free = 0.0;
  EXPECT_THAT(message_of([&] { ObstacleDetector(front_rig(), model, map_grid()); }),
              HasSubstr("sensor_model.p_free"));
}

class Recorder : public StageObserver {
 public:
  struct Event {
    bool is_begin = false;
    Stage stage = Stage::kRectify;
    std::size_t pair = 0;
    std::thread::id thread;
  };

  void begin(Stage stage, std::size_t pair) noexcept override { record(true, stage, pair); }

  void end(Stage stage, std::size_t pair) noexcept override { record(false, stage, pair); }

  [[nodiscard]] const std::vector<Event>& events() const { return events_; }

  [[nodiscard]] std::vector<Event> of_pair(std::size_t pair) const {
    std::vector<Event> result;
    std::copy_if(
        events_.begin(), events_.end(), std::back_inserter(result), [&](const Event& event) {
          return event.pair == pair;
        });
    return result;
  }

 private:
  void record(bool is_begin, Stage stage, std::size_t pair) noexcept {
    const std::lock_guard lock(mutex_);
    events_.push_back({is_begin, stage, pair, std::this_thread::get_id()});
  }

  std::mutex mutex_;
  std::vector<Event> events_;
};

/// The two events are the begin and the end of one stage, on one thread.
bool is_stage(const Recorder::Event& begin, const Recorder::Event& end, Stage stage) {
  return begin.is_begin && !end.is_begin && begin.stage == stage && end.stage == stage &&
         begin.thread == end.thread;
}

void expect_own_stages(const std::vector<Recorder::Event>& events) {
  ASSERT_GE(events.size(), 6U);
  EXPECT_TRUE(is_stage(events[0], events[1], Stage::kRectify));
  EXPECT_TRUE(is_stage(events[2], events[3], Stage::kMatch));
  EXPECT_TRUE(is_stage(events[4], events[5], Stage::kSphere));
}

TEST(ObstacleDetectorTest, TellsTheObserverEveryStageInOrder) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  Recorder recorder;
  detector.process(frames_of(2, 20, 40), Pose::Identity(), &recorder);
  expect_own_stages(recorder.of_pair(0));
  expect_own_stages(recorder.of_pair(1));
}

TEST(ObstacleDetectorTest, StitchingAndTheMapTakeAllPairsTogether) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  Recorder recorder;
  detector.process(frames_of(2, 20, 41), Pose::Identity(), &recorder);
  const std::vector<Recorder::Event>& events = recorder.events();
  ASSERT_EQ(events.size(), 16U);  // 3 stages of 2 pairs and 2 of both, begin and end
  EXPECT_TRUE(is_stage(events[12], events[13], Stage::kStitch));
  EXPECT_TRUE(is_stage(events[14], events[15], Stage::kMap));
  EXPECT_EQ(events[12].pair, 0U);
  EXPECT_EQ(events[14].pair, 0U);
}

/// Cells of the halo that come from this pair.
long cells_from(const ObstacleDetector& detector, std::uint8_t pair) {
  const auto sources = detector.halo().sources();
  return std::count(sources.begin(), sources.end(), pair);
}

TEST(ObstacleDetectorTest, TheHaloHoldsBothPairs) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  detector.process(frames_of(2, 20, 50), Pose::Identity());
  EXPECT_GT(cells_from(detector, 0), 1000);
  EXPECT_GT(cells_from(detector, 1), 1000);
  const auto depths_m = detector.halo().depths_m();
  EXPECT_EQ(std::count_if(depths_m.begin(), depths_m.end(), [](float d) { return d > 0.0F; }),
            detector.integration().things);
}

TEST(ObstacleDetectorTest, WhatAPairDoesNotDeliverIsUnseenNotOld) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  FrameSet frames = frames_of(2, 20, 51);
  frames.stamp = Timestamp(std::chrono::seconds(100));
  detector.process(frames, Pose::Identity());
  const auto sources = detector.halo().sources();
  const auto at = std::find(sources.begin(), sources.end(), 1) - sources.begin();
  const int cols = detector.halo().geometry().cols;
  const GridCell of_second{static_cast<int>(at) / cols, static_cast<int>(at) % cols};
  const long of_first = cells_from(detector, 0);

  frames = frames_of(2, 20, 51);
  frames.stamp = Timestamp(std::chrono::seconds(102));
  frames.pairs[1] = {};
  detector.process(frames, Pose::Identity());
  EXPECT_FALSE(detector.perception(1).delivered);
  EXPECT_EQ(cells_from(detector, 0), of_first);
  EXPECT_EQ(cells_from(detector, 1), 0);
  EXPECT_EQ(detector.halo().sight(of_second), Sight::kUnseen);
  EXPECT_NEAR(detector.halo().age_s(of_second, frames.stamp).value(), 2.0, 1e-9);

  frames = frames_of(2, 20, 52);
  detector.process(frames, Pose::Identity());
  EXPECT_GT(cells_from(detector, 1), 1000);
}

TEST(ObstacleDetectorTest, AnObserverChangesNothing) {
  ObstacleDetector watched(two_pair_rig(), small_config(), map_grid());
  ObstacleDetector alone(two_pair_rig(), small_config(), map_grid());
  Recorder recorder;
  watched.process(frames_of(2, 20, 42), Pose::Identity(), &recorder);
  alone.process(frames_of(2, 20, 42), Pose::Identity());
  EXPECT_EQ(cells_of(watched), cells_of(alone));
}

TEST(ObstacleDetectorTest, ARefusedFrameSetBeginsNoStage) {
  ObstacleDetector detector(two_pair_rig(), small_config(), map_grid());
  Recorder recorder;
  (void)message_of([&] { detector.process({}, Pose::Identity(), &recorder); });
  EXPECT_TRUE(recorder.events().empty());
}

}  // namespace
}  // namespace skyhalo
