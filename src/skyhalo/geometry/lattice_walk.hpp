#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "skyhalo/geometry/ray_walk.hpp"
#include "skyhalo/geometry/voxel_lattice.hpp"

namespace skyhalo {

/// Clips a ray to a box of cells; a ray that misses, or has a NaN or no direction, gives an empty
/// interval.
[[nodiscard]] inline RayInterval clip(const Ray& ray,
                                      const VoxelLattice& lattice,
                                      const CellBox& cells) noexcept {
  return clip(ray, VoxelGrid{lattice.corner_m(cells.min), lattice.voxel_m, cells.size()});
}

/// The part of a ray that lies in both.
[[nodiscard]] inline RayInterval overlap(const RayInterval& a, const RayInterval& b) noexcept {
  return {std::max(a.enter_m, b.enter_m), std::min(a.leave_m, b.leave_m)};
}

/// Visits the cells of a lattice that a part of a ray crosses, in order, from cell face to cell
/// face: `visit(cell, enter_m, leave_m) -> bool`, false to stop. `enter_m < leave_m` are distances
/// along the ray, the first and the last cut to the part. A ray that is not finite, or has no
/// direction, crosses nothing; nor does what lies beyond the cells that can be numbered. Memory:
/// none. Time: one step per cell.
template <class Visit>
void walk_lattice(const VoxelLattice& lattice,
                  const Ray& ray,
                  const RayInterval& part,
                  Visit&& visit) {
  const RayInterval inside = overlap(part, clip(ray, lattice, whole_lattice()));
  if (!(inside.leave_m > inside.enter_m)) {
    return;
  }
  Eigen::Vector3i cell = lattice.cell_of(ray.origin_m + inside.enter_m * ray.direction);
  const Eigen::Array3d inverse = ray.direction.array().inverse();
  const Eigen::Array3i step = (ray.direction.array() > 0.0).cast<int>() * 2 - 1;
  const auto face_m = [&](int axis) {  // where the ray leaves the present cell along an axis
    const int ahead = cell[axis] + (step[axis] > 0 ? 1 : 0);
    return ray.direction[axis] == 0.0
               ? std::numeric_limits<double>::infinity()
               : (lattice.origin_m[axis] + lattice.voxel_m * ahead - ray.origin_m[axis]) *
                     inverse[axis];
  };
  Eigen::Array3d next_m(face_m(0), face_m(1), face_m(2));
  double enter_m = inside.enter_m;
  while (enter_m < inside.leave_m) {
    int axis = next_m[1] < next_m[0] ? 1 : 0;
    axis = next_m[2] < next_m[axis] ? 2 : axis;
    const double leave_m = std::min(next_m[axis], inside.leave_m);
    // A chord of no length (the ray passes through an edge) is not a crossing.
    if (leave_m > enter_m && !visit(cell, enter_m, leave_m)) {
      return;
    }
    enter_m = std::max(enter_m, leave_m);
    cell[axis] += step[axis];
    next_m[axis] = face_m(axis);
  }
}

/// The same for the first `max_m` of a ray (m; infinite = to the end of the lattice).
template <class Visit>
void walk_lattice(const VoxelLattice& lattice, const Ray& ray, double max_m, Visit&& visit) {
  walk_lattice(lattice, ray, RayInterval{0.0, max_m}, visit);
}

/// Visits all cells of a box, x slowest: `visit(cell) -> bool`, false to stop. False when it was
/// stopped.
template <class Visit>
bool for_each_cell(const CellBox& box, Visit&& visit) {
  Eigen::Vector3i cell;
  for (cell.x() = box.min.x(); cell.x() < box.max.x(); ++cell.x()) {
    for (cell.y() = box.min.y(); cell.y() < box.max.y(); ++cell.y()) {
      for (cell.z() = box.min.z(); cell.z() < box.max.z(); ++cell.z()) {
        if (!visit(cell)) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace skyhalo
