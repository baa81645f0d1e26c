#include "skyhalo/pipeline/grid_rays.hpp"

#include "skyhalo/map/integrate.hpp"

namespace skyhalo {

GridRays::GridRays(const GridGeometry& geometry) {
  directions_.reserve(static_cast<std::size_t>(geometry.cell_count()));
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      directions_.push_back(geometry.center_direction({row, col}));
    }
  }
}

int GridRays::integrate(const SphericalGrid& grid,
                        const RangeModel& model,
                        const Pose& T_map_body,
                        DenseMap& map) const noexcept {
  const GridGeometry& geometry = grid.geometry();
  int rays = 0;
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      const GridCell cell{row, col};
      const std::optional<double> z_m = grid.depth_m(cell, model.depth);
      if (!z_m || !(*z_m > 0.0)) {
        continue;
      }
      const auto& direction_body = directions_[static_cast<std::size_t>(geometry.offset_of(cell))];
      const Ray ray{T_map_body.translation(), T_map_body.linear() * direction_body};
      const double uncertainty_m = delta_z_m(model.pair, *z_m, model.sensor.delta_d_px);
      skyhalo::integrate(
          ray, InverseSensorModel(model.sensor, *z_m, uncertainty_m), model.limit_units, map);
      ++rays;
    }
  }
  return rays;
}

}  // namespace skyhalo
