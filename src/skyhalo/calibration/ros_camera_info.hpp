#pragma once

#include <filesystem>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// The two cameras of ROS `camera_info` files, as `camera_calibration` writes them: `image_width`,
/// `image_height`, `camera_matrix`, `distortion_model` (`plumb_bob` with 4 or 5 coefficients,
/// `rational_polynomial` with 8, `equidistant` with 4), `distortion_coefficients`,
/// `rectification_matrix` R and `projection_matrix` P. The reference is the left camera.
///
/// How the cameras stand to each other follows from the rectified images, which differ by
/// `t = (P[0][3]/P[0][0], P[1][3]/P[1][1], 0)` of right less left:
/// `p_right = R_right^-1 (R_left p_left + t)`.
///
/// Throws `Error` (input) with file, line and key for what is missing, malformed or not supported,
/// which `binning_x` and `binning_y` other than 0 or 1 and a `roi` of less than the image are too,
/// and when P[0][3] is 0 in both files: then they say nothing of each other.
[[nodiscard]] ImportedCameras read_ros_camera_info(const std::filesystem::path& left,
                                                   const std::filesystem::path& right);

}  // namespace skyhalo
