#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "skyhalo/geometry/capsule.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/occupancy.hpp"

namespace skyhalo {

// What there is at a point, in a box, along a line or a ball's way, asked of any map of cells.
// Points are in m, in the map frame. Cells outside a map's bounds are unknown. The map does not
// change; several threads may ask at once. Nothing is allocated, except that a map without bounds
// lists its bricks when it is asked about more than `kManyBricks` of them.

/// The cell that holds a point; none for a point that is not finite or lies beyond the cells that
/// can be numbered.
[[nodiscard]] std::optional<Eigen::Vector3i> cell_holding(const VoxelLattice& lattice,
                                                          const Eigen::Vector3d& point_m) noexcept;

/// The log odds at a point; unknown where there is no cell.
template <CellMap Map>
[[nodiscard]] LogOdds at_point(const Map& map, const Eigen::Vector3d& point_m) noexcept {
  const std::optional<Eigen::Vector3i> cell = cell_holding(map.lattice(), point_m);
  return cell ? map.at(*cell) : kUnknown;
}

/// The probability that a point is occupied; 0.5 where nothing is known.
template <CellMap Map>
[[nodiscard]] double probability(const Map& map, const Eigen::Vector3d& point_m) noexcept {
  return probability_of(at_point(map, point_m));
}

template <CellMap Map>
[[nodiscard]] Occupancy occupancy(const Map& map,
                                  const Eigen::Vector3d& point_m,
                                  const OccupancyRule& rule = {}) noexcept {
  return rule(at_point(map, point_m));
}

/// What the cells that a box touches are together; its sides belong to it. A box that is empty or
/// not finite is unknown. Time: by the known cells, of a `BrickMap` by their bricks where the cells
/// of a brick are equal.
template <CellMap Map>
[[nodiscard]] Occupancy occupancy(const Map& map,
                                  const Eigen::AlignedBox3d& box_m,
                                  const OccupancyRule& rule = {}) {
  const bool is_box = box_m.min().allFinite() && box_m.max().allFinite() && !box_m.isEmpty();
  if (!is_box) {
    return Occupancy::kNotKnown;
  }
  const CellBox cells = cells_touching(map.lattice(), box_m.min(), box_m.max());
  std::int64_t free_cells = 0;
  const bool is_clear = for_each_known_block(map, cells, [&](const CellBox& block, LogOdds value) {
    const Occupancy seen = rule(value);
    free_cells += seen == Occupancy::kFree ? block.cell_count() : 0;
    return seen != Occupancy::kOccupied;
  });
  if (!is_clear) {
    return Occupancy::kOccupied;
  }
  const bool is_numbered =
      cell_holding(map.lattice(), box_m.min()) && cell_holding(map.lattice(), box_m.max());
  return is_numbered && static_cast<double>(free_cells) == count_of(cells) ? Occupancy::kFree
                                                                           : Occupancy::kNotKnown;
}

/// What the cells along a segment are together: those that it crosses, and those that hold its
/// ends. A segment that is not finite is unknown. Time: one step per cell.
template <CellMap Map>
[[nodiscard]] Occupancy occupancy(const Map& map,
                                  const Segment& segment,
                                  const OccupancyRule& rule = {}) {
  // Where the segment leaves the bounds, one of its ends is unknown.
  Occupancy all =
      together(occupancy(map, segment.from_m, rule), occupancy(map, segment.to_m, rule));
  const double length_m = segment.length_m();
  const Ray ray = segment.ray();
  const CellBox bounds = search_bounds(map, 3.0 * length_m / map.lattice().voxel_m);
  walk_lattice(map.lattice(),
               ray,
               overlap({0.0, length_m}, clip(ray, map.lattice(), bounds)),
               [&](const Eigen::Vector3i& cell, double /*enter_m*/, double /*leave_m*/) {
                 all = together(all, rule(map.at(cell)));
                 return all != Occupancy::kOccupied;
               });
  return all;
}

/// What the cells that a capsule touches are together: exactly those whose cube, faces included,
/// has a point of it, but for rounding. A capsule that is not valid is unknown. Time: by the cells;
/// when these are very many, of a `BrickMap` by the cells that are known.
template <CellMap Map>
[[nodiscard]] Occupancy occupancy(const Map& map,
                                  const Capsule& capsule,
                                  const OccupancyRule& rule = {}) {
  if (!capsule.is_valid()) {
    return Occupancy::kNotKnown;
  }
  const VoxelLattice lattice = map.lattice();
  const CellBox bounds = search_bounds(map, cells_to_look_at(lattice, capsule, map.bounds()));
  const Eigen::AlignedBox3d box_m = capsule.bounds_m();
  const bool is_inside = (box_m.min().array() > lattice.corner_m(bounds.min).array()).all() &&
                         (box_m.max().array() < lattice.corner_m(bounds.max).array()).all();
  const auto is = [&](Occupancy what, const Eigen::Vector3i& cell) {
    return rule(map.at(cell)) == what;
  };
  if constexpr (BrickMap<Map>) {
    if (cells_to_look_at(lattice, capsule, bounds) > kManyBricks) {
      for (const Eigen::Vector3i& brick : map.bricks()) {
        if (!for_each_cell_of(lattice, capsule, cells_of(brick), [&](const auto& cell) {
              return !is(Occupancy::kOccupied, cell);
            })) {
          return Occupancy::kOccupied;
        }
      }
      const bool is_free =
          is_inside && for_each_cell_of(lattice, capsule, bounds, [&](const auto& cell) {
            return is(Occupancy::kFree, cell);
          });
      return is_free ? Occupancy::kFree : Occupancy::kNotKnown;
    }
  }
  Occupancy all = is_inside ? Occupancy::kFree : Occupancy::kNotKnown;
  for_each_cell_of(lattice, capsule, bounds, [&](const Eigen::Vector3i& cell) {
    all = together(all, rule(map.at(cell)));
    return all != Occupancy::kOccupied;
  });
  return all;
}

}  // namespace skyhalo
