#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// The global map of the thesis (7.1): fixed bounds and steps in the map frame, 2 bytes a cell.
class DenseMap {
 public:
  /// All cells unknown. Throws `std::bad_alloc` when the memory cannot be had.
  explicit DenseMap(const VoxelGrid& grid)
      : grid_(grid), cells_(static_cast<std::size_t>(grid.cell_count()), kUnknown) {}

  [[nodiscard]] const VoxelGrid& grid() const noexcept { return grid_; }

  /// All cells, z fastest, then y, then x (see `VoxelGrid::offset_of`).
  [[nodiscard]] std::span<const LogOdds> cells() const noexcept { return cells_; }

  /// One cell by its position in memory, which the grid must hold.
  [[nodiscard]] LogOdds& at(std::int64_t offset) noexcept {
    return cells_[static_cast<std::size_t>(offset)];
  }

  /// The cell at a map-frame point (m); unknown outside the bounds.
  [[nodiscard]] LogOdds at_point(const Eigen::Vector3d& point_m) const noexcept {
    const Eigen::Vector3i cell = grid_.cell_of(point_m);
    return grid_.holds(cell) ? cells_[static_cast<std::size_t>(grid_.offset_of(cell))] : kUnknown;
  }

 private:
  VoxelGrid grid_;
  std::vector<LogOdds> cells_;
};

}  // namespace skyhalo
