#include "skyhalo/map/scan_rays.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/body_reach.hpp"

namespace skyhalo {

void ScanRays::walk(const RangeScan& scan,
                    const IncrementTable& table,
                    const Pose& T_map_body,
                    const VoxelLattice& lattice,
                    const CellBox& bounds) {
  table_ = &table;
  double reach_m = 0.0;
  for (std::size_t at = 0; at < scan.z_m().size(); ++at) {
    reach_m = std::max(reach_m, said_along(scan, at).leave_m);
  }
  const CellBox region = cells_in_reach(lattice, bounds, T_map_body, reach_m);
  if (region.empty()) {
    marks_.begin({});
    return;
  }
  marks_.begin(region);
  for (int row = 0; row < scan.rows(); ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols()) +
                             static_cast<std::size_t>(col);
      if (said_along(scan, at).leave_m > 0.0) {
        const Ray ray{T_map_body.translation(), T_map_body.linear() * scan.direction(row, col)};
        walk_direction(ray, lattice, region, scan, at);
      }
    }
  }
}

/// The part of a direction's ray that the scan says something of.
RayInterval ScanRays::said_along(const RangeScan& scan, std::size_t at) const noexcept {
  const double z_m = scan.z_m()[at];
  if (!(z_m > 0.0)) {
    return {0.0, scan.free_to_m()[at]};
  }
  const double delta_m = scan.delta_z_m()[at];
  const double width_m = delta_m * table_->width_ratio(table_->row_of(delta_m));
  return {0.0, z_m + IncrementTable::kWidths * width_m};
}

/// One direction's cells, from face to face. A cell's place on the ray is the point of its chord
/// nearest to the measurement, so that the cell which holds the end is the one that is marked; what
/// speaks for "free" counts with the share of the cell's edge that was crossed.
void ScanRays::walk_direction(const Ray& ray,
                              const VoxelLattice& lattice,
                              const CellBox& region,
                              const RangeScan& scan,
                              std::size_t at) {
  const double z_m = scan.z_m()[at];
  const bool has_depth = z_m > 0.0;
  const double delta_m = scan.delta_z_m()[at];
  const int row = table_->row_of(delta_m);
  const RayInterval inside = overlap(clip(ray, lattice, region), said_along(scan, at));
  walk_lattice(lattice, ray, inside, [&](const Eigen::Vector3i& cell, double from_m, double to_m) {
    const double offset_m = std::clamp(z_m, from_m, to_m) - z_m;
    const int said = has_depth ? table_->increment(row, delta_m, offset_m) : table_->crossed();
    const double share = said < 0 ? std::min(1.0, (to_m - from_m) / lattice.voxel_m) : 1.0;
    const auto increment = static_cast<Increment>(std::lround(said * share));
    if (increment != 0 && region.holds(cell)) {
      marks_.mark(cell, increment);
    }
    return true;
  });
}

}  // namespace skyhalo
