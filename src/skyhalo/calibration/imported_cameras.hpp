#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skyhalo/calibration/rig_description.hpp"

namespace skyhalo {

/// One camera as a calibration file describes it.
struct ImportedCamera {
  std::string name;
  RawCamera camera;
  Pose T_reference_camera = Pose::Identity();  ///< to the frame that all cameras of the file share
};

/// The raw cameras of a calibration: left and right of the first pair, of the second, and so on.
struct ImportedCameras {
  std::vector<ImportedCamera> cameras;
  bool reference_is_imu = false;      ///< else the frame of the first camera, or any other
  std::vector<std::string> warnings;  ///< what looks wrong in the files but can be used
};

/// The way a camera looks.
enum class Facing { kForward, kLeft, kRight, kBack, kDown, kUp };

/// The rotation of a camera (x right, y down, z forward) that looks exactly this way, level; one
/// that looks down has the vehicle's front at the top of its image, one that looks up at the
/// bottom.
[[nodiscard]] Eigen::Matrix3d R_body_camera(Facing facing) noexcept;

/// How the imported cameras sit on the vehicle.
struct Mounting {
  Facing facing = Facing::kForward;  ///< which way the first pair looks
  /// Take the IMU of the file as origin of the body; else, and without one, the first pair's right
  /// camera.
  bool body_at_imu = true;
};

/// A rig of the imported cameras, two by two. With an IMU, its axes are only renamed: of all
/// rotations by quarter turns, `T_body_imu` gets the one that makes the first pair look most nearly
/// `facing` and level, and the small angles between cameras and IMU stay. Without, the first pair's
/// right camera looks exactly that way from the body's origin. Throws `Error` (input) when the
/// number of cameras is odd or 0, or a pair has no baseline.
[[nodiscard]] RigDescription assemble_rig(const ImportedCameras& imported,
                                          const Mounting& mounting,
                                          const std::string& name);

}  // namespace skyhalo
