#pragma once

#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/map/cell_window.hpp"

namespace skyhalo {

/// The global map of the thesis (7.1): fixed bounds and steps in the map frame, 2 bytes a cell.
class DenseMap : public CellWindow {
 public:
  /// All cells unknown. Throws `std::bad_alloc` when the memory cannot be had.
  explicit DenseMap(const VoxelGrid& grid)
      : CellWindow({grid.min_m, grid.voxel_m}, {Eigen::Vector3i::Zero(), grid.size}, grid.size),
        grid_(grid) {}

  [[nodiscard]] const VoxelGrid& grid() const noexcept { return grid_; }

  /// All cells, z fastest, then y, then x (see `VoxelGrid::offset_of`).
  [[nodiscard]] std::span<const LogOdds> cells() const noexcept { return stored(); }

  using CellWindow::at;

  /// One cell by its position in memory, which the grid must hold. What is changed this way is in
  /// no tick.
  [[nodiscard]] LogOdds& at(std::int64_t offset) noexcept {
    return stored()[static_cast<std::size_t>(offset)];
  }

  /// The cell at a map-frame point (m); unknown outside the bounds.
  [[nodiscard]] LogOdds at_point(const Eigen::Vector3d& point_m) const noexcept {
    return at(grid_.cell_of(point_m));
  }

 private:
  VoxelGrid grid_;
};

}  // namespace skyhalo
