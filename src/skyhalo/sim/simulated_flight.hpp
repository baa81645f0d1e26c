#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/dataset/scene_object.hpp"
#include "skyhalo/sim/camera_look.hpp"
#include "skyhalo/sim/depth_truth.hpp"
#include "skyhalo/sim/ins_error.hpp"
#include "skyhalo/sim/laser_scanner.hpp"
#include "skyhalo/sim/scene.hpp"
#include "skyhalo/sim/scene_tracer.hpp"
#include "skyhalo/sim/sonar.hpp"
#include "skyhalo/sim/surface_colour.hpp"
#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo {

/// How a flight is looked at.
struct SimulationConfig {
  int frames = 60;              ///< > 0
  double rate_hz = 5.0;         ///< frames per second; slower flights than the trajectory end early
  std::uint64_t seed = 1;       ///< of all noise
  CameraLook look;              ///< of left cameras
  double right_gain = 0.9;      ///< right cameras: times the left one's gain
  double right_exposure = 1.2;  ///< and times its exposure's length
  InsErrorConfig ins;
  LaserScannerConfig laser;
  Pose T_body_laser = make_pose(Eigen::Matrix3d::Identity(), {0.0, 0.0, 0.2});
  SonarConfig sonar;
};

/// A flight through a scene as a recording whose images are made when they are asked for. The map
/// frame is the scene's. All cameras are triggered at the same moment: a frame's stamp is the
/// middle of the exposure of each camera's middle row.
class SimulatedFlight final : public FrameSource {
 public:
  /// Throws `Error` (input) for a scene, a camera or a setting that cannot be used.
  SimulatedFlight(Scene scene,
                  Trajectory trajectory,
                  StereoRig rig,
                  const SimulationConfig& config);

  [[nodiscard]] std::string name() const override { return scene_.name; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return config_.frames; }

  /// Counted from 2024-01-01 00:00 UTC.
  [[nodiscard]] Timestamp stamp(int frame) const override;

  /// As the INS measures it.
  [[nodiscard]] Pose T_map_body(int frame) const override;

  [[nodiscard]] FrameSet read(int frame) const override;

  /// Where the body really is.
  [[nodiscard]] Pose T_scene_body(int frame) const noexcept;

  /// Seconds from the flight's begin.
  [[nodiscard]] double time_s(int frame) const noexcept { return frame / config_.rate_hz; }

  /// The images of one pair.
  [[nodiscard]] StereoImages read_pair(int frame, std::size_t pair) const;

  /// One turn of the laser.
  [[nodiscard]] std::vector<LaserReturn> laser_returns(int frame) const;

  /// The range of the sonar (m); none without an echo.
  [[nodiscard]] std::optional<double> sonar_m(int frame) const;

  /// All that moves, and how much of each is hidden from a point (m, body) by other things.
  [[nodiscard]] std::vector<SceneObject> objects(int frame,
                                                 const Eigen::Vector3d& eye_body_m) const;

  /// What the pair's rectified right camera looks at, shrunk by a whole factor.
  [[nodiscard]] DepthTruth truth(int frame, std::size_t pair, int downscale) const;

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }

  [[nodiscard]] const SceneTracer& tracer() const noexcept { return tracer_; }

  [[nodiscard]] const Trajectory& trajectory() const noexcept { return trajectory_; }

  [[nodiscard]] const SimulationConfig& config() const noexcept { return config_; }

 private:
  struct Camera {
    CameraRays rays;
    Pose T_body_raw;
    double line_time_s = 0.0;
    CameraLook look;
  };

  [[nodiscard]] CameraShot shot_of(const Camera& camera, int frame, std::size_t index) const;
  [[nodiscard]] StereoImages render_pair(const SceneMoment& moment,
                                         int frame,
                                         std::size_t pair) const;
  [[nodiscard]] TimeSpan span_of(int frame) const noexcept;

  Scene scene_;
  Trajectory trajectory_;
  StereoRig rig_;
  SimulationConfig config_;
  SceneTracer tracer_;
  SurfaceColour colours_;
  InsError ins_;
  std::vector<Camera> cameras_;  // left and right of each pair
};

}  // namespace skyhalo
