#pragma once

#include <optional>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/occupancy.hpp"

namespace skyhalo {

/// The cell that stopped a ray.
struct RayHit {
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();
  double range_m = 0.0;  ///< to where the ray enters the cell; 0 when it starts in it
  Occupancy occupancy = Occupancy::kOccupied;
};

/// The first occupied cell that a ray (map frame) crosses within `max_range_m` (infinite = no
/// limit); with `unknown_stops` the first that is not free. None when there is none, and for a ray
/// or a range that is NaN or has no direction. Cells outside the bounds are unknown; a ray may
/// start there. Nothing is allocated. Time: one step per cell, within the bounds or, of a long ray,
/// within what a `BrickMap` knows.
template <CellMap Map>
[[nodiscard]] std::optional<RayHit> ray_cast(const Map& map,
                                             const Ray& ray,
                                             double max_range_m,
                                             const OccupancyRule& rule = {},
                                             bool unknown_stops = false) {
  const VoxelLattice lattice = map.lattice();
  RayInterval part{0.0, max_range_m};
  if (!unknown_stops) {  // else it cannot get far where nothing is known
    const CellBox bounds = search_bounds(map, 3.0 * max_range_m / lattice.voxel_m);
    part = overlap(part, clip(ray, lattice, bounds));
  }
  std::optional<RayHit> hit;
  const auto visit = [&](const Eigen::Vector3i& cell, double enter_m, double /*leave_m*/) {
    const Occupancy seen = rule(map.at(cell));
    if (seen == Occupancy::kFree || (seen == Occupancy::kNotKnown && !unknown_stops)) {
      return true;
    }
    hit = RayHit{cell, enter_m, seen};
    return false;
  };
  walk_lattice(lattice, ray, part, visit);
  return hit;
}

}  // namespace skyhalo
