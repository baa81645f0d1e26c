#pragma once

#include <limits>
#include <random>
#include <vector>

#include "skyhalo/dataset/flight_recording_writer.hpp"
#include "support/written_frames.hpp"

namespace skyhalo::testing {

inline const cv::Size kRectifiedSize(320, 96);
inline const cv::Size kRawSize(64, 48);

/// A rectified pinhole pair and a raw fisheye one.
inline RigDescription two_pairs() {
  const KannalaBrandtLens lens({30.0, 30.0, 31.0, 24.0}, {0.01, -0.002, 0.001, 1e-4});
  Pose T_right_left = Pose::Identity();
  T_right_left.translation() = Eigen::Vector3d(-0.1, 0.0, 0.0);
  PairDescription rear{
      .name = "rear",
      .images = RawPairDescription{{{kRawSize, lens}, {kRawSize, lens}, T_right_left},
                                   {.model = PairModelKind::kSpherical}},
      .T_body_camera = make_pose(
          Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ()) * forward_camera(), {-0.3, 0.1, 0.05})};
  return {.name = "test rig", .T_body_imu = {}, .pairs = {forward_pair(), rear}};
}

/// A recording with everything there is.
inline FlightDescription full_flight() {
  return {.name = "test flight",
          .source = {{"scene", "street \"7\""}, {"seed", "42"}, {"empty", ""}},
          .rig = two_pairs(),
          .T_body_laser = laser_place(),
          .has_sonar = true,
          .has_objects = true};
}

/// An upright object somewhere.
inline SceneObject upright_object(int track, const Eigen::Vector3d& bottom_m, double yaw_rad) {
  SceneObject object{.track = track, .type = "Car"};
  object.size_m = {4.1, 1.9, 1.47};
  object.T_map_object =
      make_pose(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), bottom_m);
  return object;
}

/// A frame of it with numbers that have many digits.
inline FlightFrame full_frame(unsigned seed) {
  std::mt19937 random(seed + 100);
  FlightFrame frame;
  frame.images.stamp = Timestamp(std::chrono::nanoseconds(1'700'000'000'000'000'001 + seed * 3LL));
  frame.images.pairs = {textured_images(kRectifiedSize, seed), textured_images(kRawSize, seed + 9)};
  frame.T_map_body = some_pose(random, 300.0);
  frame.true_pose = some_pose(random, 300.0);
  frame.scan = some_scan(seed);
  frame.sonar_m = 0.1 * (seed + 1);
  frame.objects = {upright_object(4, {0.1 * seed, -1.0 / 3.0, 1e-7}, 0.3 * seed)};
  frame.objects[0].occluded = 2;
  cv::Mat1f disparity_px(48, 160, 3.125F);
  disparity_px(3, 5) = std::numeric_limits<float>::quiet_NaN();
  cv::Mat1f range_m(96, 320, 1.0F / 3.0F);
  range_m(7, 9) = std::numeric_limits<float>::quiet_NaN();
  frame.truth = {{disparity_px, range_m}, {}};
  return frame;
}

/// A frame with nothing but images and a pose.
inline FlightFrame bare_frame(unsigned seed) {
  FlightFrame frame = full_frame(seed);
  frame.true_pose.reset();
  frame.scan.reset();
  frame.sonar_m.reset();
  frame.objects.clear();
  frame.truth.clear();
  return frame;
}

inline void write_flight(const std::filesystem::path& folder, int frames) {
  FlightRecordingWriter writer(folder, full_flight());
  for (int i = 0; i < frames; ++i) {
    writer.add(full_frame(static_cast<unsigned>(i)));
  }
  writer.finish();
}

}  // namespace skyhalo::testing
