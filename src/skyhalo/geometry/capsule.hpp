#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "skyhalo/geometry/lattice_walk.hpp"

namespace skyhalo {

/// The straight line between two points (m), ends included. Both ends may be the same.
struct Segment {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_finite() const noexcept { return from_m.allFinite() && to_m.allFinite(); }

  [[nodiscard]] double length_m() const noexcept { return (to_m - from_m).stableNorm(); }

  /// From one end towards the other; without a direction when both are the same.
  [[nodiscard]] Ray ray() const noexcept { return {from_m, (to_m - from_m).stableNormalized()}; }

  [[nodiscard]] Eigen::AlignedBox3d bounds_m() const noexcept {
    return {from_m.cwiseMin(to_m), from_m.cwiseMax(to_m)};
  }
};

/// All points at most a radius (m, >= 0) away from a segment: where a ball passes.
struct Capsule {
  Segment axis;
  double radius_m = 0.0;

  [[nodiscard]] bool is_valid() const noexcept {
    return axis.is_finite() && radius_m >= 0.0 && std::isfinite(radius_m);
  }

  [[nodiscard]] Eigen::AlignedBox3d bounds_m() const noexcept {
    const Eigen::AlignedBox3d box = axis.bounds_m();
    return {box.min().array() - radius_m, box.max().array() + radius_m};
  }
};

/// Square of the distance between a segment and a box (m^2), 0 where they touch. Exact but for
/// rounding. Both finite, the box not empty.
[[nodiscard]] double squared_distance_m2(const Segment& segment,
                                         const Eigen::AlignedBox3d& box_m) noexcept;

/// True when a cell's cube, faces included, has a point of the capsule.
[[nodiscard]] bool touches(const Capsule& capsule,
                           const VoxelLattice& lattice,
                           const Eigen::Vector3i& cell) noexcept;

/// A box of cells that holds all those that the capsule touches, not much larger.
[[nodiscard]] CellBox cells_near(const VoxelLattice& lattice, const Capsule& capsule) noexcept;

/// The axis along which the capsule reaches farthest.
[[nodiscard]] int longest_axis(const Capsule& capsule) noexcept;

/// The cells of one layer (`axis`, `index`) that may touch the capsule, as a box.
[[nodiscard]] CellBox layer_near(const VoxelLattice& lattice,
                                 const Capsule& capsule,
                                 int axis,
                                 int index) noexcept;

/// An upper bound of the number of cells that `for_each_cell_of` looks at within a box.
[[nodiscard]] double cells_to_look_at(const VoxelLattice& lattice,
                                      const Capsule& capsule,
                                      const CellBox& within) noexcept;

/// Visits the cells of a box that a capsule touches, layer by layer along its longest axis:
/// `visit(cell) -> bool`, false to stop. False when it was stopped. The capsule is valid.
template <class Visit>
bool for_each_cell_of(const VoxelLattice& lattice,
                      const Capsule& capsule,
                      const CellBox& within,
                      Visit&& visit) {
  const int axis = longest_axis(capsule);
  const CellBox box = overlap(within, cells_near(lattice, capsule));
  for (int index = box.min[axis]; index < box.max[axis]; ++index) {
    const CellBox layer = overlap(box, layer_near(lattice, capsule, axis, index));
    const bool whole = for_each_cell(layer, [&](const Eigen::Vector3i& cell) {
      return !touches(capsule, lattice, cell) || visit(cell);
    });
    if (!whole) {
      return false;
    }
  }
  return true;
}

}  // namespace skyhalo
