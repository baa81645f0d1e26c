#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace skyhalo {

/// An axis-aligned box of the map frame divided into equal cubes. Cell (i, j, k) covers the
/// half-open cube `[min + index * voxel, min + (index + 1) * voxel)`; z runs fastest in memory.
struct VoxelGrid {
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();  ///< the corner with the smallest coordinates
  double voxel_m = 1.0;                             ///< edge of a cell, > 0
  Eigen::Vector3i size = Eigen::Vector3i::Zero();   ///< cells along x, y, z

  [[nodiscard]] std::int64_t cell_count() const noexcept {
    return std::int64_t{size.x()} * size.y() * size.z();
  }

  /// The corner with the largest coordinates (m).
  [[nodiscard]] Eigen::Vector3d max_m() const noexcept {
    return min_m + voxel_m * size.cast<double>();
  }

  /// The cell that contains a map-frame point; it may lie outside the grid (see `holds`).
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& point_m) const noexcept {
    const Eigen::Vector3d scaled = (point_m - min_m) / voxel_m;
    // Clamped, so that far or NaN coordinates stay representable and simply lie outside.
    const auto index = [](double x) {
      return x > -1.0 && x < 2.0e9 ? static_cast<int>(std::floor(x)) : -1;
    };
    return {index(scaled.x()), index(scaled.y()), index(scaled.z())};
  }

  [[nodiscard]] bool holds(const Eigen::Vector3i& cell) const noexcept {
    return (cell.array() >= 0).all() && (cell.array() < size.array()).all();
  }

  /// Position in memory of a cell that the grid holds, in [0, cell_count()).
  [[nodiscard]] std::int64_t offset_of(const Eigen::Vector3i& cell) const noexcept {
    return (std::int64_t{cell.x()} * size.y() + cell.y()) * size.z() + cell.z();
  }

  /// The cell at a position in memory; the inverse of `offset_of`.
  [[nodiscard]] Eigen::Vector3i cell_at(std::int64_t offset) const noexcept {
    const std::int64_t column = offset / size.z();
    return {static_cast<int>(column / size.y()),
            static_cast<int>(column % size.y()),
            static_cast<int>(offset % size.z())};
  }

  /// Centre of a cell (m, map frame).
  [[nodiscard]] Eigen::Vector3d center_m(const Eigen::Vector3i& cell) const noexcept {
    return min_m + voxel_m * (cell.cast<double>().array() + 0.5).matrix();
  }
};

/// The grid of cells that covers `bounds_m`; the far sides move outwards to whole cells.
/// Throws `Error` (input) unless voxel_m > 0, each side is longer than zero and the grid has fewer
/// than 2^31 cells.
[[nodiscard]] VoxelGrid make_voxel_grid(const Eigen::AlignedBox3d& bounds_m, double voxel_m);

}  // namespace skyhalo
