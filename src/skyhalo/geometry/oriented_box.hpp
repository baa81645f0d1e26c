#pragma once

#include <Eigen/Core>

namespace skyhalo {

/// A box in any orientation: one corner and the three edges that meet there (m, any one frame).
struct OrientedBox {
  Eigen::Vector3d corner_m = Eigen::Vector3d::Zero();     ///< p0
  Eigen::Matrix3d edges_m = Eigen::Matrix3d::Identity();  ///< columns p1-p0, p3-p0, p4-p0
};

/// True when the point (same frame as the box) lies in the box or on its surface: `u.p` lies
/// between `u.p0` and `u.p1`, and likewise for v with p3 and w with p4, where u, v, w are the
/// normals of the faces that meet in p0 (thesis appendix A). A point with a NaN is outside.
[[nodiscard]] bool contains(const OrientedBox& box, const Eigen::Vector3d& point_m) noexcept;

}  // namespace skyhalo
