#include "skyhalo/evaluation/ground_truth.hpp"

#include <algorithm>
#include <limits>

#include "skyhalo/geometry/ray_walk.hpp"

namespace skyhalo {

bool is_seen(const TruthCamera& camera,
             const Eigen::Vector3d& point_camera_m,
             double max_range_m) noexcept {
  if (!(point_camera_m.z() > 0.0) || point_camera_m.squaredNorm() > max_range_m * max_range_m) {
    return false;
  }
  const double px_per_m = camera.focal_px / point_camera_m.z();
  const double u_px = point_camera_m.x() * px_per_m + camera.principal_u_px;
  const double v_px = point_camera_m.y() * px_per_m + camera.principal_v_px;
  return u_px >= 0.0 && u_px < camera.image_size_px.width && v_px >= 0.0 &&
         v_px < camera.image_size_px.height;
}

std::vector<std::int64_t> occupied_cells(const LaserScan& scan,
                                         const TruthView& view,
                                         std::span<const OrientedBox> boxes,
                                         const VoxelGrid& grid) {
  std::vector<std::int64_t> offsets;
  for (const Eigen::Vector3f& point : scan) {
    const Eigen::Vector3d p_laser_m = point.cast<double>();
    if (!is_seen(view.camera, view.camera.T_camera_laser * p_laser_m, view.max_range_m)) {
      continue;
    }
    const Eigen::Vector3d p_annotation_m = view.T_annotation_laser * p_laser_m;
    const bool in_box = std::any_of(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
      return contains(box, p_annotation_m);
    });
    const Eigen::Vector3i cell = grid.cell_of(view.T_map_laser * p_laser_m);
    if (!in_box && grid.holds(cell)) {
      offsets.push_back(grid.offset_of(cell));
    }
  }
  std::sort(offsets.begin(), offsets.end());
  offsets.erase(std::unique(offsets.begin(), offsets.end()), offsets.end());
  return offsets;
}

std::vector<std::uint8_t> observed_cells(const LaserScan& scan,
                                         const TruthView& view,
                                         const VoxelGrid& grid) {
  constexpr double kAnyRange = std::numeric_limits<double>::infinity();
  std::vector<std::uint8_t> observed(static_cast<std::size_t>(grid.cell_count()), 0);
  for (const Eigen::Vector3f& point : scan) {
    const Eigen::Vector3d p_laser_m = point.cast<double>();
    if (!is_seen(view.camera, view.camera.T_camera_laser * p_laser_m, kAnyRange)) {
      continue;
    }
    const double end_m = std::min(p_laser_m.norm(), view.max_range_m);
    const Ray ray{view.T_map_laser.translation(),
                  view.T_map_laser.linear() * p_laser_m.normalized()};
    walk_ray(grid, ray, [&](std::int64_t offset, double enter_m, double) {
      if (enter_m > end_m) {
        return false;
      }
      observed[static_cast<std::size_t>(offset)] = 1;
      return true;
    });
  }
  return observed;
}

void GroundTruth::mark_observed(std::span<const std::uint8_t> observed) noexcept {
  for (std::size_t i = 0; i < observed_.size(); ++i) {
    observed_[i] |= observed[i];
  }
}

void GroundTruth::mark(std::span<const std::int64_t> offsets) noexcept {
  for (const std::int64_t offset : offsets) {
    occupied_[static_cast<std::size_t>(offset)] = 1;
  }
}

std::vector<std::int64_t> GroundTruth::occupied_offsets() const {
  std::vector<std::int64_t> offsets;
  for (std::size_t i = 0; i < occupied_.size(); ++i) {
    if (occupied_[i] != 0) {
      offsets.push_back(static_cast<std::int64_t>(i));
    }
  }
  return offsets;
}

}  // namespace skyhalo
