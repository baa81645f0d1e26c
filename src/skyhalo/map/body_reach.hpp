#pragma once

#include <algorithm>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/brick.hpp"

namespace skyhalo {

/// The cells of a box within some range of the body (m), and of `kMostReachCells`.
[[nodiscard]] inline CellBox cells_in_reach(const VoxelLattice& lattice,
                                            const CellBox& bounds,
                                            const Pose& T_map_body,
                                            double reach_m) noexcept {
  const double most_m = kMostReachCells * lattice.voxel_m;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(std::min(reach_m, most_m));
  const Eigen::Vector3d center_m = T_map_body.translation();
  return overlap(bounds, cells_touching(lattice, center_m - reach, center_m + reach));
}

/// Whether scans can be entered from a pose: finite, and in a cell that can be numbered.
[[nodiscard]] inline bool can_enter(const VoxelLattice& lattice, const Pose& T_map_body) noexcept {
  return T_map_body.matrix().allFinite() && lattice.reaches(T_map_body.translation());
}

}  // namespace skyhalo
