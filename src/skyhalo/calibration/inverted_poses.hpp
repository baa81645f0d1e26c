#pragma once

#include <string_view>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// Adds a warning when the poses look as if they were given the wrong way round: the baseline of
/// the first pair does not lie along the image rows, but would if every `T_reference_camera` were
/// inverted. `key` is what the file calls the poses. Internal to this layer.
void warn_if_poses_look_inverted(ImportedCameras& imported, std::string_view key);

/// Adds a warning when a file that should refer to an IMU refers to its first camera.
void warn_if_reference_is_camera(ImportedCameras& imported, std::string_view key);

}  // namespace skyhalo
