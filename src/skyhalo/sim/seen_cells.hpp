#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/geometry/ray_walk.hpp"
#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo {

/// How closely cameras' views are looked through.
struct SeenCellsConfig {
  double max_range_m = 15.0;  ///< from the camera
  int hit_step_px = 2;        ///< every so many pixels, what a ray ends in is noted, >= 1
  int walk_step_px = 4;       ///< and what it crosses on the way, a multiple of `hit_step_px`
};

/// The cells of a grid (frame of the scene) that cameras have seen: those that a ray of a pixel
/// crossed or ended in.
class SeenCells {
 public:
  explicit SeenCells(const VoxelGrid& grid)
      : grid_(grid), seen_(static_cast<std::size_t>(grid.cell_count()), 0) {}

  /// Adds what the rectified right camera of a pair sees at a moment. `T_scene_camera` places it.
  void add(const SceneMoment& moment,
           const PairModel& pair,
           const cv::Size& size_px,
           const Pose& T_scene_camera,
           const SeenCellsConfig& config);

  /// 1 for seen, by position in the grid's memory.
  [[nodiscard]] std::span<const std::uint8_t> seen() const noexcept { return seen_; }

 private:
  void look_along(const SceneMoment& moment, const Ray& way, double max_range_m, bool mark_way);

  VoxelGrid grid_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace skyhalo
