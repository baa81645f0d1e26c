#include "skyhalo/map/integrate.hpp"

#include <algorithm>

namespace skyhalo {

void integrate(const Ray& ray,
               const InverseSensorModel& model,
               int limit_units,
               DenseMap& map) noexcept {
  const double z_m = model.z_m();
  const double free_until_m = model.free_until_m();
  const double cells_per_m = 1.0 / map.grid().voxel_m;
  const double crossed = log_odds(model.probability(0.0));
  const int unknown_units = log_odds_units(log_odds(model.p_unknown()));
  walk_ray(map.grid(), ray, [&](std::int64_t offset, double enter_m, double leave_m) {
    const double said = leave_m < free_until_m
                            ? crossed
                            : log_odds(model.probability(std::clamp(z_m, enter_m, leave_m)));
    if (enter_m > z_m && log_odds_units(said) == unknown_units) {
      return false;
    }
    const double share = said < 0.0 ? std::min(1.0, (leave_m - enter_m) * cells_per_m) : 1.0;
    LogOdds& cell = map.at(offset);
    cell = updated(cell, log_odds_units(said * share), limit_units);
    return true;
  });
}

}  // namespace skyhalo
