#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/io/staged_folder.hpp"
#include "skyhalo/io/trajectory_file.hpp"

namespace skyhalo {

/// Writes a flight of one pair in EuRoC's (ASL) layout, which `EurocFlight` reads: `mav0/cam0`
/// (left) and `cam1` (right) with `data.csv`, `data/` and `sensor.yaml`, `mav0/body.yaml` and
/// `mav0/state_groundtruth_estimate0`. The body is the IMU. There is no `imu0`: turn rates and
/// accelerations are not recorded; the ground truth's velocities are differences of poses and its
/// biases 0.
///
/// The files are written to a hidden folder beside `folder`, which is renamed by `finish()`;
/// without it nothing stays. Used by one thread at a time.
class EurocWriter {
 public:
  /// `pair` is raw with radial-tangential or Kannala-Brandt (equidistant) lenses, or a rectified
  /// pinhole pair. Throws `Error` (input) for any other, and `Error` (failure) when the folder
  /// cannot be made or holds something already.
  EurocWriter(const std::filesystem::path& folder, const PairDescription& pair);

  /// Adds the next frame: images of the cameras' sizes and a pose in a map with z up. Throws
  /// `Error` (input) naming the frame for stamps that do not grow, images that do not fit or a pose
  /// that is not rigid; `Error` (failure) when it cannot be written.
  void add(const StampedPose& pose, const StereoImages& images);

  /// Makes the flight appear. Throws `Error` (input) without a frame and `Error` (failure) when it
  /// cannot be written or was finished before.
  void finish();

 private:
  struct Camera {
    RawCamera camera;
    Pose T_body_camera = Pose::Identity();
  };

  static std::vector<Camera> cameras_of(const PairDescription& pair);

  StagedFolder staged_;
  std::vector<Camera> cameras_;  // left, right
  std::vector<StampedPose> poses_;
};

}  // namespace skyhalo
