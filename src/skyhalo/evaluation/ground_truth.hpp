#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skyhalo/dataset/laser_source.hpp"
#include "skyhalo/geometry/oriented_box.hpp"
#include "skyhalo/geometry/voxel_grid.hpp"

namespace skyhalo {

/// What decides which points of a scan are ground truth (METHOD 7).
struct TruthView {
  TruthCamera camera;
  Pose T_annotation_laser = Pose::Identity();  ///< scanner to the frame of the boxes
  Pose T_map_laser = Pose::Identity();         ///< scanner to map, at the time of the scan
  double max_range_m = 0.0;                    ///< from the camera
};

/// True when a point (m, camera frame) is in front of the camera, within `max_range_m` of it, and
/// projects to `0 <= u < width`, `0 <= v < height`.
[[nodiscard]] bool is_seen(const TruthCamera& camera,
                           const Eigen::Vector3d& point_camera_m,
                           double max_range_m) noexcept;

/// Cells (positions in the grid's memory, sorted, each once) that a scan marks as occupied: those
/// with a point that the camera sees and that lies in none of the boxes, which hold what may
/// move.
[[nodiscard]] std::vector<std::int64_t> occupied_cells(const LaserScan& scan,
                                                       const TruthView& view,
                                                       std::span<const OrientedBox> boxes,
                                                       const VoxelGrid& grid);

/// 1 for every cell (by position in the grid's memory) that a ray of the scan crossed or ended in,
/// within `max_range_m` of the scanner, among the rays whose point projects into the camera's
/// image.
[[nodiscard]] std::vector<std::uint8_t> observed_cells(const LaserScan& scan,
                                                       const TruthView& view,
                                                       const VoxelGrid& grid);

/// The occupied cells of a whole sequence; one point is enough.
class GroundTruth {
 public:
  explicit GroundTruth(const VoxelGrid& grid)
      : grid_(grid),
        occupied_(static_cast<std::size_t>(grid.cell_count()), 0),
        observed_(occupied_.size(), 0) {}

  /// Marks cells as occupied.
  void mark(std::span<const std::int64_t> offsets) noexcept;

  /// Adds cells that the laser observed: 1 in a list as long as the grid.
  void mark_observed(std::span<const std::uint8_t> observed) noexcept;

  [[nodiscard]] const VoxelGrid& grid() const noexcept { return grid_; }

  /// 1 for cells that the laser observed, by position in the grid's memory.
  [[nodiscard]] std::span<const std::uint8_t> observed() const noexcept { return observed_; }

  /// 1 for occupied, 0 for free, by position in the grid's memory.
  [[nodiscard]] std::span<const std::uint8_t> occupied() const noexcept { return occupied_; }

  /// Positions of the occupied cells, ascending.
  [[nodiscard]] std::vector<std::int64_t> occupied_offsets() const;

 private:
  VoxelGrid grid_;
  std::vector<std::uint8_t> occupied_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace skyhalo
