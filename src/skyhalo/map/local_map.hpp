#pragma once

#include "skyhalo/map/cell_window.hpp"

namespace skyhalo {

/// The local map of the thesis (7.2): a fixed number of cells round the drone, which is always in
/// the central one; the axes stay those of the map frame, only the position follows. The lattice is
/// the map frame's: cell (0, 0, 0) begins at its origin.
class LocalMap : public CellWindow {
 public:
  /// All cells unknown, the drone at the origin. Throws `Error` (input) unless `voxel_m` > 0 and
  /// each side has 1 to 4096 cells.
  LocalMap(const Eigen::Vector3i& size_cells, double voxel_m);

  /// Moves the map so that a position (m, map frame) lies in the central cell, `bounds().min +
  /// size/2`. Cells that leave are forgotten, cells that enter are unknown; only those are touched.
  /// A position that is not finite moves nothing.
  void follow(const Eigen::Vector3d& position_m) noexcept;
};

/// The number of cells of a local map with these sides (m), rounded up to whole cells. Throws
/// `Error` (input) unless both are above 0 and each side has at most 4096 cells.
[[nodiscard]] Eigen::Vector3i local_map_cells(const Eigen::Vector3d& size_m, double voxel_m);

}  // namespace skyhalo
