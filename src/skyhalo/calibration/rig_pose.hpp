#pragma once

#include <string>
#include <vector>

#include "skyhalo/calibration/yaml_value.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// A pose of a rig file: a 4x4 matrix, or `position_m: [x, y, z]` with `yaw_deg`, `pitch_deg` and
/// `roll_deg` (0 when left out) about z, y and x of the outer frame's axes carried along, in this
/// order, on top of the rotation `R_outer_inner`. In the body frame (x forward, y left, z up) yaw
/// is positive to the left, pitch downwards, roll to the right. Throws and warns as `pose_from`.
/// Internal to this layer.
[[nodiscard]] Pose read_placement(const YamlValue& value,
                                  const Eigen::Matrix3d& R_outer_inner,
                                  std::vector<std::string>& warnings);

}  // namespace skyhalo
