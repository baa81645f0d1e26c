#pragma once

#include <Eigen/Core>
#include <optional>

#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// The order in which maps list their bricks: by x, then y, then z.
[[nodiscard]] bool before(const Eigen::Vector3i& a, const Eigen::Vector3i& b) noexcept;

/// Where cell (0, 0, 0) of lattice `b` lies in the cells of lattice `a`, if the two have the same
/// cells: edges that are equal but for the six digits that some files keep, origins that are whole
/// cells apart but for a thousandth of one. Throws `Error` (input) saying how they differ.
[[nodiscard]] Eigen::Vector3i offset_to_same_cells(const VoxelLattice& a, const VoxelLattice& b);

/// The map with all cells moved: cell c of the map is cell `c + offset` of the result, whose
/// lattice is another. None when a known cell would go beyond those that can be numbered.
[[nodiscard]] std::optional<SparseMap> moved(const SparseMap& map,
                                             const VoxelLattice& lattice,
                                             const Eigen::Vector3i& offset);

/// As `moved`; throws `Error` (input) instead of none.
[[nodiscard]] SparseMap moved_to(const SparseMap& map,
                                 const VoxelLattice& lattice,
                                 const Eigen::Vector3i& offset);

}  // namespace skyhalo
