#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace skyhalo {

/// Space divided into equal cubes without end. Cell (i, j, k) covers the half-open cube
/// `[origin + index * voxel, origin + (index + 1) * voxel)` of the map frame.
struct VoxelLattice {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< the smallest corner of cell (0, 0, 0)
  double voxel_m = 1.0;                                ///< edge of a cell, > 0

  friend bool operator==(const VoxelLattice&, const VoxelLattice&) = default;

  /// Cells are numbered from -kReach to kReach - 1 along each axis; points beyond, and NaN, fall
  /// into the outermost ones.
  static constexpr int kReach = 1 << 24;

  /// The cell that contains a map-frame point (m).
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& point_m) const noexcept {
    const auto index = [](double x) {
      return x < kReach ? static_cast<int>(std::floor(std::max(x, -1.0 * kReach))) : kReach - 1;
    };
    const Eigen::Vector3d scaled = (point_m - origin_m) / voxel_m;
    return {index(scaled.x()), index(scaled.y()), index(scaled.z())};
  }

  /// Whether a point is finite and in a cell of its own, not beyond the outermost ones.
  [[nodiscard]] bool reaches(const Eigen::Vector3d& point_m) const noexcept {
    return (((point_m - origin_m) / voxel_m).array().abs() < kReach).all();
  }

  /// The smallest corner of a cell (m, map frame).
  [[nodiscard]] Eigen::Vector3d corner_m(const Eigen::Vector3i& cell) const noexcept {
    return origin_m + voxel_m * cell.cast<double>();
  }

  /// Centre of a cell (m, map frame).
  [[nodiscard]] Eigen::Vector3d center_m(const Eigen::Vector3i& cell) const noexcept {
    return origin_m + voxel_m * (cell.cast<double>().array() + 0.5).matrix();
  }
};

/// The cells with `min <= index < max` along each axis.
struct CellBox {
  Eigen::Vector3i min = Eigen::Vector3i::Zero();
  Eigen::Vector3i max = Eigen::Vector3i::Zero();

  friend bool operator==(const CellBox&, const CellBox&) = default;

  [[nodiscard]] Eigen::Vector3i size() const noexcept { return (max - min).cwiseMax(0); }

  [[nodiscard]] bool empty() const noexcept { return (max.array() <= min.array()).any(); }

  [[nodiscard]] bool holds(const Eigen::Vector3i& cell) const noexcept {
    return (cell.array() >= min.array()).all() && (cell.array() < max.array()).all();
  }

  [[nodiscard]] std::int64_t cell_count() const noexcept {
    return size().cast<std::int64_t>().prod();
  }
};

/// The cells of both.
[[nodiscard]] inline CellBox overlap(const CellBox& a, const CellBox& b) noexcept {
  return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)};
}

/// Calls `visit(CellBox)` for up to six boxes that together are what `box` has without `without`.
template <class Visit>
void for_each_piece_without(const CellBox& box, const CellBox& without, Visit&& visit) {
  const CellBox common = overlap(box, without);
  if (common.empty()) {
    visit(box);
    return;
  }
  CellBox rest = box;
  for (int axis = 0; axis < 3; ++axis) {
    CellBox below = rest;
    below.max[axis] = common.min[axis];
    CellBox above = rest;
    above.min[axis] = common.max[axis];
    rest.min[axis] = common.min[axis];
    rest.max[axis] = common.max[axis];
    for (const CellBox& piece : {below, above}) {
      if (!piece.empty()) {
        visit(piece);
      }
    }
  }
}

/// The cells of a lattice that a box (m, map frame) touches.
[[nodiscard]] inline CellBox cells_touching(const VoxelLattice& lattice,
                                            const Eigen::Vector3d& min_m,
                                            const Eigen::Vector3d& max_m) noexcept {
  return {lattice.cell_of(min_m), lattice.cell_of(max_m) + Eigen::Vector3i::Ones()};
}

/// All cells that can be numbered.
[[nodiscard]] inline CellBox whole_lattice() noexcept {
  return {Eigen::Vector3i::Constant(-VoxelLattice::kReach),
          Eigen::Vector3i::Constant(VoxelLattice::kReach)};
}

}  // namespace skyhalo
