#include "skyhalo/map/map_query.hpp"

namespace skyhalo {

std::optional<Eigen::Vector3i> cell_holding(const VoxelLattice& lattice,
                                            const Eigen::Vector3d& point_m) noexcept {
  const Eigen::Array3d scaled = (point_m - lattice.origin_m) / lattice.voxel_m;
  const bool is_numbered =
      (scaled >= -1.0 * VoxelLattice::kReach).all() && (scaled < 1.0 * VoxelLattice::kReach).all();
  return is_numbered ? std::optional(lattice.cell_of(point_m)) : std::nullopt;
}

}  // namespace skyhalo
