#pragma once

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// How two cameras turn, each about its own centre, to become a rectified pair: x along the
/// baseline from left to right, z between the two optical axes and square to it (after Fusiello,
/// Trucco, Verri 2000, who took one camera's axis).
struct CommonOrientation {
  Eigen::Matrix3d R_left_cam;   ///< `cam` to raw left camera
  Eigen::Matrix3d R_right_cam;  ///< `cam` to raw right camera
  double baseline_m;
};

/// The common orientation of two raw cameras. Throws `Error` (input) naming `T_right_left` when
/// there is no baseline, the left camera is not on the left (swapped cameras or inverted
/// extrinsics), or the two look different ways.
[[nodiscard]] CommonOrientation common_orientation(const Pose& T_right_left);

}  // namespace skyhalo
