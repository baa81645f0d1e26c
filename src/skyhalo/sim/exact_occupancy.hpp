#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

/// Whether a triangle (three corners, m) and a cell of a grid have a point in common: the cell's
/// lower sides belong to it, its upper ones do not (separating axes, Akenine-Moeller 2001). A
/// triangle that only touches the cell's surface in one point may count either way.
[[nodiscard]] bool meets_cell(const Eigen::Matrix3d& corners_m,
                              const VoxelGrid& grid,
                              const Eigen::Vector3i& cell) noexcept;

/// 1 for the cells of a grid that a triangle of the mesh (frame of the grid) passes through, 0 for
/// all others, by position in the grid's memory. What lies inside a closed mesh is not filled.
[[nodiscard]] std::vector<std::uint8_t> exact_occupancy(const TriangleMesh& mesh,
                                                        const VoxelGrid& grid);

}  // namespace skyhalo
