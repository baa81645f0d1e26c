#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "reference/naive_ray_tracer.hpp"

namespace skyhalo::reference {

/// Distance (m) from a point to the straight line between two others.
inline double naive_segment_distance_m(const Eigen::Vector3d& point_m,
                                       const Eigen::Vector3d& from_m,
                                       const Eigen::Vector3d& to_m) {
  const Eigen::Vector3d along_m = to_m - from_m;
  const double squared = along_m.squaredNorm();
  const double share =
      squared > 0.0 ? std::clamp((point_m - from_m).dot(along_m) / squared, 0.0, 1.0) : 0.0;
  return (from_m + share * along_m - point_m).norm();
}

/// Distance (m) from a point to a triangle: to its plane where the foot lies inside, else to the
/// nearest of its edges.
inline double naive_triangle_distance_m(const Eigen::Vector3d& point_m,
                                        const std::array<Eigen::Vector3d, 3>& corners_m) {
  const Eigen::Vector3d normal =
      (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized();
  const double height_m = normal.dot(point_m - corners_m[0]);
  const NaiveCrossing foot = naive_crossing(point_m, -normal, corners_m);
  if (!normal.isZero(0.0) && foot.inside() >= 0.0) {
    return std::abs(height_m);
  }
  return std::min({naive_segment_distance_m(point_m, corners_m[0], corners_m[1]),
                   naive_segment_distance_m(point_m, corners_m[1], corners_m[2]),
                   naive_segment_distance_m(point_m, corners_m[2], corners_m[0])});
}

/// Distance (m) from a point to the nearest triangle.
inline double naive_surface_distance_m(const Eigen::Vector3d& point_m,
                                       const std::vector<NaiveTriangle>& triangles) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const NaiveTriangle& triangle : triangles) {
    nearest_m = std::min(nearest_m, naive_triangle_distance_m(point_m, triangle.corners_m));
  }
  return nearest_m;
}

}  // namespace skyhalo::reference
