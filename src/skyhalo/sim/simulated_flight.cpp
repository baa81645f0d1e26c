#include "skyhalo/sim/simulated_flight.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

/// What the random numbers are for.
enum class Noise : std::uint64_t { kImage, kPose, kLaser, kSonar };

std::uint64_t key_of(std::uint64_t seed, Noise noise, int frame, std::size_t sensor = 0) {
  return random_bits(
      {seed, static_cast<std::uint64_t>(noise), static_cast<std::uint64_t>(frame), sensor});
}

const SimulationConfig& checked(const SimulationConfig& config) {
  check(config.look);
  check(config.laser);
  const auto expect = [](bool holds, const char* what) {
    if (!holds) {
      throw Error(ErrorKind::kInput, std::string("simulation: ") + what);
    }
  };
  expect(config.frames >= 1 && config.frames <= 1000000, "frames: expected 1...1000000");
  expect(config.rate_hz >= 0.01 && config.rate_hz <= 1000.0, "rate_hz: expected 0.01...1000");
  expect(config.right_gain > 0.0 && config.right_gain <= 100.0, "right_gain: expected 0...100");
  expect(config.right_exposure > 0.0 && config.right_exposure <= 100.0,
         "right_exposure: expected 0...100");
  return config;
}

CameraLook right_look(const SimulationConfig& config) {
  CameraLook look = config.look;
  look.gain *= config.right_gain;
  look.exposure_s *= config.right_exposure;
  return look;
}

/// 0 when hardly anything of a mover is hidden by other things, 1 when a part is, 2 when most is.
int occlusion(const SceneMoment& moment,
              std::size_t mover,
              const Pose& T_scene_object,
              const Eigen::Vector3d& eye_m) {
  constexpr std::size_t kPoints = 100;
  constexpr float kToleranceM = 0.05F;
  const auto& vertices_m = moment.scene().movers[mover].mesh.vertices_m;
  const std::size_t step = std::max<std::size_t>(vertices_m.size() / kPoints, 1);
  int asked = 0;
  int hidden = 0;
  for (std::size_t i = 0; i < vertices_m.size(); i += step) {
    const Eigen::Vector3d way_m = T_scene_object * vertices_m[i].cast<double>() - eye_m;
    const double range_m = way_m.norm();
    const SceneHit hit = moment.trace({eye_m.cast<float>(), (way_m / range_m).cast<float>(), 0.5F});
    ++asked;
    hidden +=
        hit.object != 1 + mover && hit.range_m < static_cast<float>(range_m) - kToleranceM ? 1 : 0;
  }
  if (10 * hidden <= asked) {
    return 0;
  }
  return 5 * hidden <= 3 * asked ? 1 : 2;
}

}  // namespace

SimulatedFlight::SimulatedFlight(Scene scene,
                                 Trajectory trajectory,
                                 StereoRig rig,
                                 const SimulationConfig& config)
    : scene_(std::move(scene)),
      trajectory_(std::move(trajectory)),
      rig_(std::move(rig)),
      config_(checked(config)),
      tracer_(scene_),
      colours_(tracer_),
      ins_(config.ins, trajectory_.duration_s() + config.frames / config.rate_hz) {
  for (const StereoPair& pair : rig_.pairs) {
    const Pose T_cam_left =
        make_pose(Eigen::Matrix3d::Identity(), {-baseline_m(pair.model), 0.0, 0.0});
    if (pair.raw) {
      const Pose T_cam_raw = T_cam_left * Pose(pair.raw->R_left_cam.transpose());
      cameras_.push_back({CameraRays(pair.raw->left),
                          pair.T_body_camera * T_cam_raw,
                          pair.line_time_s,
                          config_.look});
      cameras_.push_back({CameraRays(pair.raw->right),
                          pair.T_body_camera * Pose(pair.raw->R_right_cam.transpose()),
                          pair.line_time_s,
                          right_look(config_)});
    } else {
      cameras_.push_back({CameraRays(pair.model, pair.image_size_px, true),
                          pair.T_body_camera * T_cam_left,
                          pair.line_time_s,
                          config_.look});
      cameras_.push_back({CameraRays(pair.model, pair.image_size_px, false),
                          pair.T_body_camera,
                          pair.line_time_s,
                          right_look(config_)});
    }
  }
}

Timestamp SimulatedFlight::stamp(int frame) const {
  constexpr std::chrono::sys_days kFirstDay =
      std::chrono::year(2024) / std::chrono::January / std::chrono::day(1);
  return Timestamp(kFirstDay) +
         std::chrono::nanoseconds(static_cast<std::int64_t>(std::llround(time_s(frame) * 1e9)));
}

Pose SimulatedFlight::T_scene_body(int frame) const noexcept {
  return trajectory_.T_map_body(time_s(frame));
}

Pose SimulatedFlight::T_map_body(int frame) const {
  return ins_.measured([this](double t_s) { return trajectory_.T_map_body(t_s); },
                       time_s(frame),
                       key_of(config_.seed, Noise::kPose, frame));
}

CameraShot SimulatedFlight::shot_of(const Camera& camera, int frame, std::size_t index) const {
  return {.stamp_s = time_s(frame),
          .line_time_s = camera.line_time_s,
          .T_scene_camera = [this, T_body_raw = camera.T_body_raw](
                                double t_s) { return trajectory_.T_map_body(t_s) * T_body_raw; },
          .noise_key = key_of(config_.seed, Noise::kImage, frame, index)};
}

TimeSpan SimulatedFlight::span_of(int frame) const noexcept {
  TimeSpan span{time_s(frame), time_s(frame)};
  for (const Camera& camera : cameras_) {
    const TimeSpan exposed = exposed_span(
        camera.rays.size_px().height,
        {.stamp_s = time_s(frame), .line_time_s = camera.line_time_s, .T_scene_camera = {}},
        camera.look);
    span.begin_s = std::min(span.begin_s, exposed.begin_s);
    span.end_s = std::max(span.end_s, exposed.end_s);
  }
  return span;
}

StereoImages SimulatedFlight::render_pair(const SceneMoment& moment,
                                          int frame,
                                          std::size_t pair) const {
  std::array<cv::Mat3b, 2> images;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t index = 2 * pair + side;
    const Camera& camera = cameras_[index];
    images[side] =
        render(moment, colours_, camera.rays, shot_of(camera, frame, index), camera.look);
  }
  return {images[0], images[1]};
}

StereoImages SimulatedFlight::read_pair(int frame, std::size_t pair) const {
  return render_pair(SceneMoment(tracer_, span_of(frame)), frame, pair);
}

FrameSet SimulatedFlight::read(int frame) const {
  const SceneMoment moment(tracer_, span_of(frame));
  FrameSet frames{stamp(frame), {}};
  for (std::size_t pair = 0; pair < rig_.pairs.size(); ++pair) {
    frames.pairs.push_back(render_pair(moment, frame, pair));
  }
  return frames;
}

std::vector<LaserReturn> SimulatedFlight::laser_returns(int frame) const {
  const double half_s = 0.5 * config_.laser.turn_s;
  const SceneMoment moment(tracer_, {time_s(frame) - half_s, time_s(frame) + half_s});
  return scan(
      moment,
      [this](double t_s) { return trajectory_.T_map_body(t_s) * config_.T_body_laser; },
      time_s(frame),
      key_of(config_.seed, Noise::kLaser, frame),
      config_.laser);
}

std::optional<double> SimulatedFlight::sonar_m(int frame) const {
  const SceneMoment moment(tracer_, {time_s(frame), time_s(frame)});
  return sonar_range_m(moment,
                       T_scene_body(frame) * config_.sonar.T_body_sonar,
                       key_of(config_.seed, Noise::kSonar, frame),
                       config_.sonar);
}

std::vector<SceneObject> SimulatedFlight::objects(int frame,
                                                  const Eigen::Vector3d& eye_body_m) const {
  const SceneMoment moment(tracer_, {time_s(frame), time_s(frame)});
  const Eigen::Vector3d eye_m = T_scene_body(frame) * eye_body_m;
  std::vector<SceneObject> objects;
  for (std::size_t i = 0; i < scene_.movers.size(); ++i) {
    const MovingObject& mover = scene_.movers[i];
    objects.push_back(
        {.track = mover.track,
         .type = mover.type,
         .size_m = mover.size_m,
         .T_map_object = T_scene_object(mover, time_s(frame)),
         .occluded = occlusion(moment, i, T_scene_object(mover, time_s(frame)), eye_m)});
  }
  return objects;
}

DepthTruth SimulatedFlight::truth(int frame, std::size_t pair, int downscale) const {
  const StereoPair& looking = rig_.pairs[pair];
  const SceneMoment moment(tracer_, {time_s(frame), time_s(frame)});
  return depth_truth(moment,
                     downscaled(looking.model, downscale),
                     looking.image_size_px / downscale,
                     T_scene_body(frame) * looking.T_body_camera);
}

}  // namespace skyhalo
