#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/occupancy.hpp"

namespace skyhalo {

/// A cell, and how far the nearest point of its cube is.
struct NearCell {
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();
  double distance_m = 0.0;
};

/// Gathers the nearest of several cells to a point; of equally near ones the one that is smaller in
/// x, then y, then z.
class NearestCell {
 public:
  /// Cells farther than `radius_m` do not count.
  NearestCell(const VoxelLattice& lattice, const Eigen::Vector3d& point_m, double radius_m) noexcept
      : lattice_(lattice), point_m_(point_m), limit_m2_(radius_m * radius_m) {}

  void offer(const Eigen::Vector3i& cell) noexcept;

  /// False when no cell of a box can be nearer than what was found.
  [[nodiscard]] bool may_gain(const CellBox& cells) const noexcept {
    return !cells.empty() && squared_distance_m2(cells) <= limit_m2_;
  }

  /// False when no cell outside a box can be nearer than what was found.
  [[nodiscard]] bool may_gain_outside(const CellBox& cells) const noexcept;

  [[nodiscard]] std::optional<NearCell> found() const noexcept {
    return is_found_ ? std::optional(NearCell{cell_, std::sqrt(limit_m2_)}) : std::nullopt;
  }

 private:
  [[nodiscard]] double squared_distance_m2(const CellBox& cells) const noexcept;

  VoxelLattice lattice_;
  Eigen::Vector3d point_m_;
  double limit_m2_;
  Eigen::Vector3i cell_ = Eigen::Vector3i::Zero();
  bool is_found_ = false;
};

/// Visits the elements of a box that are `ring` away from a middle along the axis along which they
/// are farthest: `visit(element)`.
template <class Visit>
void for_each_in_shell(const CellBox& box, const Eigen::Vector3i& middle, int ring, Visit&& visit) {
  const CellBox cube{middle.array() - ring, middle.array() + ring + 1};
  const CellBox part = overlap(box, cube);
  Eigen::Vector3i at;
  for (at.x() = part.min.x(); at.x() < part.max.x(); ++at.x()) {
    for (at.y() = part.min.y(); at.y() < part.max.y(); ++at.y()) {
      const bool is_side =
          std::abs(at.x() - middle.x()) == ring || std::abs(at.y() - middle.y()) == ring;
      const int step = is_side ? 1 : std::max(1, 2 * ring);  // else its two ends alone
      for (at.z() = is_side ? part.min.z() : cube.min.z(); at.z() < part.max.z(); at.z() += step) {
        if (at.z() >= part.min.z()) {
          visit(at);
        }
      }
    }
  }
}

/// The occupied cell whose cube is nearest to a point (m, map frame), at most `radius_m` (m,
/// infinite = no limit) away; of equally near ones the smallest in x, then y, then z. None for a
/// point that is not finite and a radius below 0. Looks brick by brick, from the point outwards.
/// Nothing is allocated, except that a map without bounds lists its bricks when it would have to
/// look at more than `kManyBricks`.
template <CellMap Map>
[[nodiscard]] std::optional<NearCell> nearest_occupied(const Map& map,
                                                       const Eigen::Vector3d& point_m,
                                                       double radius_m,
                                                       const OccupancyRule& rule = {}) {
  if (!point_m.allFinite() || !(radius_m >= 0.0)) {
    return std::nullopt;
  }
  const VoxelLattice lattice = map.lattice();
  CellBox cells = cells_touching(lattice, point_m.array() - radius_m, point_m.array() + radius_m);
  cells.min.array() -= 1;  // the cell below a face
  cells = overlap(cells, map.bounds());
  cells = overlap(cells, search_bounds(map, count_of(cells)));
  NearestCell nearest(lattice, point_m, radius_m);
  if (cells.empty()) {
    return std::nullopt;
  }
  const auto visit_brick = [&](const Eigen::Vector3i& brick) {
    if (!nearest.may_gain(overlap(cells, cells_of(brick)))) {
      return;
    }
    for_each_known_block_of(map, brick, cells, [&](const CellBox& block, LogOdds value) {
      return rule(value) != Occupancy::kOccupied || for_each_cell(block, [&](const auto& cell) {
               nearest.offer(cell);
               return true;
             });
    });
  };
  const CellBox bricks = bricks_touching(cells);
  if constexpr (BrickMap<Map>) {
    if (count_of(bricks) > kManyBricks) {
      for (const Eigen::Vector3i& brick : map.bricks()) {
        visit_brick(brick);
      }
      return nearest.found();
    }
  }
  const Eigen::Vector3i middle = brick_of(lattice.cell_of(point_m));
  const auto farthest = [&middle](const Eigen::Vector3i& brick) {
    return (brick - middle).cwiseAbs();
  };
  const int last = farthest(bricks.min).cwiseMax(farthest(bricks.max)).maxCoeff();
  const Eigen::Vector3i nearest_brick =
      middle.cwiseMax(bricks.min).cwiseMin((bricks.max.array() - 1).matrix());
  for (int ring = farthest(nearest_brick).maxCoeff(); ring <= last; ++ring) {
    const CellBox inner{first_cell(middle.array() - (ring - 1)), first_cell(middle.array() + ring)};
    if (ring > 0 && !nearest.may_gain_outside(inner)) {
      break;
    }
    for_each_in_shell(bricks, middle, ring, visit_brick);
  }
  return nearest.found();
}

}  // namespace skyhalo
