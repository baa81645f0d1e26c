#include "skyhalo/pipeline/halo_rays.hpp"

#include "skyhalo/map/integrate.hpp"

namespace skyhalo {

HaloRays::HaloRays(const GridGeometry& geometry) {
  directions_.reserve(static_cast<std::size_t>(geometry.cell_count()));
  for (int cell = 0; cell < geometry.cell_count(); ++cell) {
    directions_.push_back(geometry.center_direction({cell / geometry.cols, cell % geometry.cols}));
  }
}

int HaloRays::integrate(const Halo& halo,
                        std::span<const RangeModel> models,
                        const Pose& T_map_body,
                        DenseMap& map) const noexcept {
  int rays = 0;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double z_m = halo.depths_m()[i];
    const std::size_t source = halo.sources()[i];
    if (!(z_m > 0.0) || source >= models.size()) {
      continue;
    }
    const RangeModel& model = models[source];
    const Ray ray{T_map_body.translation(), T_map_body.linear() * directions_[i]};
    const double uncertainty_m = delta_z_m(model.pair, z_m, model.sensor.delta_d_px);
    skyhalo::integrate(
        ray, InverseSensorModel(model.sensor, z_m, uncertainty_m), model.limit_units, map);
    ++rays;
  }
  return rays;
}

}  // namespace skyhalo
