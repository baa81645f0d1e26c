#pragma once

#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// The known cells of a map with bounds, as a map without: what map files hold.
[[nodiscard]] inline SparseMap to_sparse(const CellMap auto& map) {
  SparseMap sparse(map.lattice());
  BrickCells cells;  // NOLINT(*-member-init): filled by the map
  for_each_cell(bricks_touching(map.bounds()), [&](const Eigen::Vector3i& brick) {
    map.copy_brick(brick, cells);
    sparse.set_brick(brick, cells);
    return true;
  });
  return sparse;
}

/// A map without bounds as it is.
[[nodiscard]] inline SparseMap to_sparse(const SparseMap& map) {
  return map;
}

}  // namespace skyhalo
