#include "skyhalo/map/integrate.hpp"

#include <algorithm>

namespace skyhalo {

void integrate(const Ray& ray,
               const InverseSensorModel& model,
               int limit_units,
               DenseMap& map) noexcept {
  const double z_m = model.z_m();
  const double free_until_m = model.free_until_m();
  const int crossed_units = log_odds_units(model.probability(0.0 < free_until_m ? 0.0 : z_m));
  walk_ray(map.grid(), ray, [&](std::int64_t offset, double enter_m, double leave_m) {
    LogOdds& cell = map.at(offset);
    if (leave_m < free_until_m) {
      cell = updated(cell, crossed_units, limit_units);
      return true;
    }
    const int units = log_odds_units(model.probability(std::clamp(z_m, enter_m, leave_m)));
    if (enter_m > z_m && units == 0) {
      return false;
    }
    cell = updated(cell, units, limit_units);
    return true;
  });
}

}  // namespace skyhalo
