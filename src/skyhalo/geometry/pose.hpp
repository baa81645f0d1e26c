#pragma once

#include <Eigen/Geometry>

namespace skyhalo {

/// A rigid transform. `T_a_b` takes coordinates in frame b to frame a: `p_a = T_a_b * p_b`.
/// Frames: `map` (z up, fixed), `body` (x forward, y left, z up), `cam` (x right, y down,
/// z forward; the rectified right camera of a pair).
using Pose = Eigen::Isometry3d;

/// The rigid transform with this rotation and translation (m).
[[nodiscard]] inline Pose make_pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t_m) {
  Pose T = Pose::Identity();
  T.linear() = R;
  T.translation() = t_m;
  return T;
}

/// True when R is a proper rotation within `tolerance` (each entry of R*R' - I, and det R > 0).
[[nodiscard]] inline bool is_rotation(const Eigen::Matrix3d& R, double tolerance) {
  const Eigen::Matrix3d residual = R * R.transpose() - Eigen::Matrix3d::Identity();
  return residual.cwiseAbs().maxCoeff() <= tolerance && R.determinant() > 0.0;
}

}  // namespace skyhalo
