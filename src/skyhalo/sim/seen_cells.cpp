#include "skyhalo/sim/seen_cells.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/sim/pair_ray.hpp"

namespace skyhalo {
namespace {

void mark(std::uint8_t& cell) noexcept {
  std::atomic_ref<std::uint8_t>(cell).store(1, std::memory_order_relaxed);
}

}  // namespace

void SeenCells::look_along(const SceneMoment& moment,
                           const Ray& way,
                           double max_range_m,
                           bool mark_way) {
  const SceneHit hit = moment.trace({way.origin_m.cast<float>(), way.direction.cast<float>(), 0.5F},
                                    static_cast<float>(max_range_m));
  const double range_m = std::min(static_cast<double>(hit.range_m), max_range_m);
  const Eigen::Vector3i end = grid_.cell_of(way.origin_m + range_m * way.direction);
  if (hit.object != SceneHit::kNothing && grid_.holds(end)) {
    mark(seen_[static_cast<std::size_t>(grid_.offset_of(end))]);
  }
  if (mark_way) {
    walk_ray(grid_, way, [&](std::int64_t offset, double enter_m, double) {
      if (enter_m >= range_m) {
        return false;
      }
      mark(seen_[static_cast<std::size_t>(offset)]);
      return true;
    });
  }
}

void SeenCells::add(const SceneMoment& moment,
                    const PairModel& pair,
                    const cv::Size& size_px,
                    const Pose& T_scene_camera,
                    const SeenCellsConfig& config) {
  const auto rows = static_cast<std::size_t>((size_px.height - 1) / config.hit_step_px) + 1;
  for_each_index(rows, [&](std::size_t i) {
    const int row = static_cast<int>(i) * config.hit_step_px;
    for (int col = 0; col < size_px.width; col += config.hit_step_px) {
      const Eigen::Vector3d ray =
          ray_or_zero(pair, {static_cast<double>(col), static_cast<double>(row)});
      if (!ray.isZero(0.0)) {
        look_along(moment,
                   {T_scene_camera.translation(), T_scene_camera.linear() * ray},
                   config.max_range_m,
                   row % config.walk_step_px == 0 && col % config.walk_step_px == 0);
      }
    }
  });
}

}  // namespace skyhalo
