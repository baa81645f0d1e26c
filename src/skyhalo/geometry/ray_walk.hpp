#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "skyhalo/geometry/voxel_grid.hpp"

namespace skyhalo {

/// A half-line of the map frame: `origin + s * direction`, s >= 0 in metres.
struct Ray {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector
};

/// The part [enter, leave] of a ray that lies inside a box; empty when leave <= enter.
struct RayInterval {
  double enter_m = 0.0;
  double leave_m = std::numeric_limits<double>::infinity();
};

/// Clips a ray to the box of a grid (slab test); a ray that misses, or has a NaN or no direction,
/// gives an empty interval.
[[nodiscard]] inline RayInterval clip(const Ray& ray, const VoxelGrid& grid) noexcept {
  RayInterval inside;
  if (ray.direction.isZero(0.0)) {
    return {0.0, 0.0};
  }
  const Eigen::Vector3d max_m = grid.max_m();
  for (int axis = 0; axis < 3; ++axis) {
    const double to_min_m = grid.min_m[axis] - ray.origin_m[axis];
    const double to_max_m = max_m[axis] - ray.origin_m[axis];
    if (ray.direction[axis] == 0.0) {
      if (!(to_min_m <= 0.0 && to_max_m > 0.0)) {  // NaN lies outside too
        return {0.0, 0.0};
      }
      continue;
    }
    const double first = to_min_m / ray.direction[axis];
    const double second = to_max_m / ray.direction[axis];
    if (std::isnan(first) || std::isnan(second)) {
      return {0.0, 0.0};
    }
    inside.enter_m = std::max(inside.enter_m, std::min(first, second));
    inside.leave_m = std::min(inside.leave_m, std::max(first, second));
  }
  return inside;
}

/// Visits the cells that a ray crosses, in order, from cell face to cell face (Amanatides and Woo
/// 1987): `visit(offset, enter_m, leave_m) -> bool`, false to stop. `enter_m` and `leave_m` are
/// distances along the ray; the first is 0 when the ray starts inside the cell.
template <class Visit>
void walk_ray(const VoxelGrid& grid, const Ray& ray, Visit&& visit) {
  const RayInterval inside = clip(ray, grid);
  if (!(inside.leave_m > inside.enter_m)) {
    return;
  }
  const Eigen::Vector3d start_m = ray.origin_m + inside.enter_m * ray.direction;
  Eigen::Vector3i cell =
      grid.cell_of(start_m).cwiseMax(0).cwiseMin((grid.size.array() - 1).matrix());
  Eigen::Vector3i step = Eigen::Vector3i::Zero();
  Eigen::Vector3d next_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d stride_m = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] != 0.0) {
      step[axis] = ray.direction[axis] > 0.0 ? 1 : -1;
      const double face_m =
          grid.min_m[axis] + grid.voxel_m * (cell[axis] + (step[axis] > 0 ? 1 : 0));
      next_m[axis] = (face_m - ray.origin_m[axis]) / ray.direction[axis];
      stride_m[axis] = grid.voxel_m / std::abs(ray.direction[axis]);
    }
  }
  double enter_m = inside.enter_m;
  while (true) {
    int axis = 0;
    const double leave_m = next_m.minCoeff(&axis);
    // A chord of no length (the ray passes through an edge) is not a crossing.
    if (leave_m > enter_m && !visit(grid.offset_of(cell), enter_m, leave_m)) {
      return;
    }
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= grid.size[axis]) {
      return;
    }
    enter_m = std::max(enter_m, leave_m);
    next_m[axis] += stride_m[axis];
  }
}

}  // namespace skyhalo
