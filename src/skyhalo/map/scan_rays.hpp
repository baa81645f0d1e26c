#pragma once

#include <cstddef>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/geometry/ray_walk.hpp"
#include "skyhalo/map/brick_marks.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "skyhalo/sensor_model/increment_table.hpp"

namespace skyhalo {

/// What a scan says of the cells of a map by walking along one ray per direction, from cell to cell
/// (Amanatides and Woo 1987; the thesis's way). Keeps its memory from scan to scan.
class ScanRays {
 public:
  /// Room for scans of maps that have no more bricks than this.
  void reserve(std::size_t bricks) { marks_.reserve(bricks); }

  /// Walks all rays through the cells of `bounds`. The pose must be one that `can_enter`.
  void walk(const RangeScan& scan,
            const IncrementTable& table,
            const Pose& T_map_body,
            const VoxelLattice& lattice,
            const CellBox& bounds);

  /// What they say.
  [[nodiscard]] const BrickMarks& marks() const noexcept { return marks_; }

 private:
  [[nodiscard]] RayInterval said_along(const RangeScan& scan, std::size_t at) const noexcept;
  void walk_direction(const Ray& ray,
                      const VoxelLattice& lattice,
                      const CellBox& region,
                      const RangeScan& scan,
                      std::size_t at);

  const IncrementTable* table_ = nullptr;  // of the scan at hand
  BrickMarks marks_;
};

}  // namespace skyhalo
