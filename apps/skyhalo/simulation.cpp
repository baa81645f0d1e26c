#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "reference_rig_text.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/camera/shrunk_camera.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sim/clear_orbit.hpp"
#include "skyhalo/sim/flight_plan.hpp"
#include "skyhalo/sim/make_scene.hpp"
#include "skyhalo/sim/mesh_file.hpp"
#include "skyhalo/sim/path_check.hpp"
#include "skyhalo/sim/trajectory_text.hpp"

namespace skyhalo::app {
namespace {

constexpr double kUsualRateHz = 5.0;

std::string scene_list() {
  std::string list;
  for (const SceneKind& kind : scene_kinds()) {
    list += "\n  " + std::string(kind.name) + ": " + std::string(kind.what) +
            "; difficulty: " + std::string(kind.difficulty);
  }
  return list;
}

bool is_scene_name(const std::string& name) {
  const auto kinds = scene_kinds();
  return std::any_of(
      kinds.begin(), kinds.end(), [&](const SceneKind& kind) { return kind.name == name; });
}

/// Whether the text can only mean a file.
bool looks_like_file(const std::string& text) {
  return text.find('/') != std::string::npos || text.find('.') != std::string::npos ||
         std::filesystem::exists(text);
}

UpAxis up_axis(const std::string& name) {
  if (name == "x") {
    return UpAxis::kX;
  }
  return name == "y" ? UpAxis::kY : UpAxis::kZ;
}

const std::vector<Eigen::Vector3d>& route_of(const Scene& scene) {
  if (!scene.route_m.empty()) {
    return scene.route_m;
  }
  throw Error(ErrorKind::kInput,
              scene.name +
                  ": this scene has no route of its own; give a trajectory file with "
                  "--trajectory");
}

FlightPlan plan_of(const SimulationOptions& options, const Scene& scene, FlightKind kind) {
  const std::vector<Eigen::Vector3d>& route_m = route_of(scene);
  FlightPlan plan;
  plan.kind = kind;
  plan.waypoints_m = route_m;
  plan.is_closed = scene.route_closed;
  plan.limits.speed_mps = options.speed_mps;
  plan.hover.position_m = route_m.front();
  plan.hover.seed = options.seed;
  if (kind == FlightKind::kOrbit) {
    const auto orbit = clear_orbit(scene, options.speed_mps, options.body_radius_m);
    if (!orbit) {
      throw Error(ErrorKind::kInput,
                  scene.name + ": there is no room for a circle along its route");
    }
    plan.orbit = *orbit;
  }
  return plan;
}

Trajectory open_trajectory(const SimulationOptions& options, const Scene& scene) {
  const std::string& name = options.trajectory;
  const auto kind = flight_kind(name);
  if (kind) {
    return fly(plan_of(options, scene, *kind));
  }
  WaypointOptions waypoints;
  waypoints.limits.speed_mps = options.speed_mps;
  return read_trajectory(name, waypoints);
}

/// Frames and how fast they follow each other.
void set_frames(const SimulationOptions& options, double duration_s, SimulationConfig& config) {
  const bool any = options.frames == 0 && options.rate_hz == 0.0;
  const int frames = any ? options.usual_frames : options.frames;
  config.rate_hz = kUsualRateHz;
  if (options.rate_hz != 0.0) {
    config.rate_hz = options.rate_hz;
  } else if (frames > 1) {
    config.rate_hz = (frames - 1) / duration_s;
  }
  const double fit = std::floor(duration_s * config.rate_hz * (1.0 + 1e-9)) + 1.0;
  if (frames > fit) {
    throw UsageError("--frames " + std::to_string(frames) + ": the flight takes " +
                     number_text("%.1f", duration_s) + " s and has " + number_text("%.0f", fit) +
                     " frames at " + number_text("%g", config.rate_hz) + " Hz");
  }
  config.frames = frames > 0 ? frames : static_cast<int>(std::min(fit, 1e6));
}

SimulationConfig config_of(const SimulationOptions& options, double duration_s) {
  SimulationConfig config;
  set_frames(options, duration_s, config);
  config.seed = options.seed;
  config.look.samples = options.samples;
  config.laser.range_sigma_m = options.laser_sigma_m;
  config.ins.seed = options.seed;
  config.ins.delay_s = options.ins_delay_s;
  if (!options.ins_noise.empty()) {
    config.ins.position_sigma_m = options.ins_noise[0];
    config.ins.attitude_sigma_rad = rad_from_deg(options.ins_noise[1]);
  }
  if (!options.ins_drift.empty()) {
    config.ins.position_drift_m_per_sqrt_s = options.ins_drift[0];
    config.ins.yaw_drift_rad_per_sqrt_s = rad_from_deg(options.ins_drift[1]);
  }
  config.sonar.T_body_sonar.linear() =
      Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
  return config;
}

std::string text_of(const Approach& approach) {
  const Eigen::Vector3d& p_m = approach.position_m;
  return "the trajectory passes through the scene: " + number_text("%.2f", approach.distance_m) +
         " m from a surface at t = " + number_text("%.2f", approach.t_s) + " s, x " +
         number_text("%.2f", p_m.x()) + ", y " + number_text("%.2f", p_m.y()) + ", z " +
         number_text("%.2f", p_m.z()) + " m";
}

void add_scene_options(CLI::App& command, SimulationOptions& options) {
  command
      .add_option("--scene",
                  options.scene,
                  "a generated scene or a mesh file (OBJ, PLY, glTF). Scenes:" + scene_list())
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command.add_option("--difficulty", options.difficulty, "of a generated scene, 0 (easy) to 1")
      ->type_name("X")
      ->capture_default_str();
  command.add_option("--unit-m", options.unit_m, "mesh file: length of its unit in metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--up", options.up, "mesh file: the axis that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
}

void add_flight_options(CLI::App& command, SimulationOptions& options) {
  command
      .add_option(
          "--trajectory",
          options.trajectory,
          "route (the scene's own), hover (at its start), orbit (the widest clear circle about "
          "a place on it), aggressive (the route, up to 12 m/s), or a file: TUM, or CSV with a "
          "header line out of t_s,x_m,y_m,z_m,yaw_deg,roll_deg,pitch_deg")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command.add_option("--speed", options.speed_mps, "limit of route, orbit and waypoints (m/s)")
      ->type_name("MPS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--body-radius",
                  options.body_radius_m,
                  "a trajectory that comes nearer than this to a surface is an error (m)")
      ->type_name("M")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag(
      "--may-collide", options.may_collide, "fly through surfaces all the same, with a warning");
  command
      .add_option("--frames",
                  options.frames,
                  "number of frames (default: " +
                      (options.usual_frames > 0 ? std::to_string(options.usual_frames)
                                                : std::string("all of the flight")) +
                      ")")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--rate",
                  options.rate_hz,
                  "frames per second (default: what spreads --frames over the flight, without them "
                  "5; kitti-tracking: 10)")
      ->type_name("HZ")
      ->check(CLI::Range(0.001, 10000.0));
  command.add_option("--seed", options.seed, "of scene and noise; the same seed, the same flight")
      ->type_name("K")
      ->capture_default_str();
  command.add_option("--samples", options.samples, "rays per pixel: 1, 4, 9 or 16")
      ->check(CLI::IsMember({1, 4, 9, 16}))
      ->capture_default_str();
}

void add_sensor_options(CLI::App& command, SimulationOptions& options) {
  command
      .add_option(
          "--ins-noise", options.ins_noise, "standard deviation of each pose: metres and degrees")
      ->type_name("M,DEG")
      ->expected(2)
      ->delimiter(',');
  command
      .add_option("--ins-drift",
                  options.ins_drift,
                  "random walk of the poses: metres and degrees of heading per square root of a "
                  "second")
      ->type_name("M,DEG")
      ->expected(2)
      ->delimiter(',');
  command.add_option("--ins-delay", options.ins_delay_s, "poses are this old (s)")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void add_simulation_options(CLI::App& command, SimulationOptions& options) {
  add_scene_options(command, options);
  add_flight_options(command, options);
  add_sensor_options(command, options);
}

Scene open_scene(const SimulationOptions& options) {
  if (!is_scene_name(options.scene) && looks_like_file(options.scene)) {
    return read_scene(options.scene, {.unit_m = options.unit_m, .up = up_axis(options.up)});
  }
  return make_scene(
      {.name = options.scene, .difficulty = options.difficulty, .seed = options.seed});
}

RigDescription reference_rig() {
  return parse_rig(kReferenceRig, "the built-in reference rig").description;
}

RigDescription at_matched_resolution(const RigDescription& rig, MatchingConfig& matching) {
  RigDescription small = rig;
  for (PairDescription& pair : small.pairs) {
    pair.masks_px.insert(pair.masks_px.end(), matching.masks_px.begin(), matching.masks_px.end());
    const int factor = pair.downscale.value_or(matching.downscale);
    pair.downscale = 1;
    pair.line_time_s *= factor;  // the same time for the whole image
    for (cv::Rect& mask : pair.masks_px) {
      mask = downscaled(mask, factor);
    }
    if (auto* rectified = std::get_if<RectifiedPairDescription>(&pair.images)) {
      rectified->model = downscaled(rectified->model, factor);
      rectified->size_px /= factor;
      continue;
    }
    auto& raw = std::get<RawPairDescription>(pair.images);
    raw.cameras.left = downscaled(raw.cameras.left, factor);
    raw.cameras.right = downscaled(raw.cameras.right, factor);
    if (raw.rectify_to.size_px) {
      *raw.rectify_to.size_px /= factor;
    }
  }
  matching.masks_px.clear();
  return small;
}

std::unique_ptr<SimulatedFlight> make_flight(const SimulationOptions& options,
                                             const CommonOptions& common,
                                             Scene scene,
                                             StereoRig rig) {
  Trajectory trajectory = open_trajectory(options, scene);
  const SimulationConfig config = config_of(options, trajectory.duration_s());
  auto flight = std::make_unique<SimulatedFlight>(
      std::move(scene), std::move(trajectory), std::move(rig), config);
  const auto collision = first_collision(flight->tracer(),
                                         flight->trajectory(),
                                         flight->time_s(flight->frame_count() - 1),
                                         options.body_radius_m);
  if (collision && options.may_collide) {
    print_warnings(common, {text_of(*collision)});
  } else if (collision) {
    throw Error(
        ErrorKind::kInput,
        options.trajectory + ": " + text_of(*collision) + "; --may-collide flies it all the same");
  }
  return flight;
}

}  // namespace skyhalo::app
