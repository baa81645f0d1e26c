#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "skyhalo/geometry/ray_walk.hpp"

namespace skyhalo::testing {

/// An upright cylinder (m, map frame).
struct Pillar {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  double radius_m = 0.25;
  double bottom_m = 0.0;
  double top_m = 1.0;
};

/// A range to nothing.
inline constexpr double kNowhereM = std::numeric_limits<double>::infinity();

/// Where a line is inside the slabs of a box; leave < enter when nowhere.
inline RayInterval inside_of(const Ray& ray, const Eigen::AlignedBox3d& box_m) {
  RayInterval inside{-kNowhereM, kNowhereM};
  for (int axis = 0; axis < 3; ++axis) {
    const double from_m = ray.origin_m[axis];
    if (ray.direction[axis] == 0.0) {
      const bool is_between = from_m > box_m.min()[axis] && from_m < box_m.max()[axis];
      inside = is_between ? inside : RayInterval{kNowhereM, -kNowhereM};
      continue;
    }
    const double a_m = (box_m.min()[axis] - from_m) / ray.direction[axis];
    const double b_m = (box_m.max()[axis] - from_m) / ray.direction[axis];
    inside.enter_m = std::max(inside.enter_m, std::min(a_m, b_m));
    inside.leave_m = std::min(inside.leave_m, std::max(a_m, b_m));
  }
  return inside;
}

/// Where a line is inside a pillar; leave < enter when nowhere.
inline RayInterval inside_of(const Ray& ray, const Pillar& pillar) {
  const Eigen::Vector2d from_m = ray.origin_m.head<2>() - pillar.middle_m;
  const double a = ray.direction.head<2>().squaredNorm();
  const double b = from_m.dot(ray.direction.head<2>());
  const double c = from_m.squaredNorm() - pillar.radius_m * pillar.radius_m;
  RayInterval inside{-kNowhereM, kNowhereM};
  if (a > 0.0) {
    const double root = b * b - a * c;
    if (root <= 0.0) {
      return {kNowhereM, -kNowhereM};
    }
    inside = {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
  } else if (c >= 0.0) {
    return {kNowhereM, -kNowhereM};
  }
  const double z_m = ray.origin_m.z();
  const double up = ray.direction.z();
  if (up == 0.0) {
    return z_m > pillar.bottom_m && z_m < pillar.top_m ? inside
                                                       : RayInterval{kNowhereM, -kNowhereM};
  }
  const double low_m = (pillar.bottom_m - z_m) / up;
  const double high_m = (pillar.top_m - z_m) / up;
  return {std::max(inside.enter_m, std::min(low_m, high_m)),
          std::min(inside.leave_m, std::max(low_m, high_m))};
}

/// From outside a solid to where the ray enters it.
inline double range_to(const RayInterval& inside) {
  if (inside.leave_m > inside.enter_m && inside.enter_m >= 0.0) {
    return inside.enter_m;
  }
  return kNowhereM;
}

/// True when the surface of a box passes through a cube.
inline bool cuts(const Eigen::AlignedBox3d& box_m, const Eigen::AlignedBox3d& cube_m) {
  const bool is_within = (cube_m.min().array() > box_m.min().array()).all() &&
                         (cube_m.max().array() < box_m.max().array()).all();
  return box_m.intersects(cube_m) && !is_within;
}

inline bool cuts(const Pillar& pillar, const Eigen::AlignedBox3d& cube_m) {
  const Eigen::Array2d below = cube_m.min().head<2>() - pillar.middle_m;
  const Eigen::Array2d above = cube_m.max().head<2>() - pillar.middle_m;
  const double nearest_m = below.max(-above).max(0.0).matrix().norm();
  const double farthest_m = below.abs().max(above.abs()).matrix().norm();
  const bool meets = nearest_m <= pillar.radius_m && cube_m.min().z() <= pillar.top_m &&
                     cube_m.max().z() >= pillar.bottom_m;
  const bool is_within = farthest_m < pillar.radius_m && cube_m.min().z() > pillar.bottom_m &&
                         cube_m.max().z() < pillar.top_m;
  return meets && !is_within;
}

}  // namespace skyhalo::testing
