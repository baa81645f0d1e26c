#pragma once

#include <string>

#include "skyhalo/calibration/key_value_file.hpp"
#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Two rectified cameras of a KITTI file. `reference` is the rectified camera 00. Internal to this
/// layer.
struct KittiProjections {
  PinholePair pair;
  Pose T_left_reference = Pose::Identity();
  Pose T_right_reference = Pose::Identity();
};

/// The pair of two 3x4 projection matrices P = K [I | t]. Throws `Error` (input) with file, line
/// and key when one is missing or malformed, they do not belong to one rectified pair, or the right
/// camera is not to the right of the left one.
[[nodiscard]] KittiProjections read_kitti_projections(const KeyValueFile& file,
                                                      const std::string& left_key,
                                                      const std::string& right_key);

/// The rotation of 9 numbers; KITTI prints seven digits. Throws `Error` (input) with file, line and
/// key when they are none.
[[nodiscard]] Eigen::Matrix3d read_kitti_rotation(const KeyValueFile& file, const std::string& key);

}  // namespace skyhalo
