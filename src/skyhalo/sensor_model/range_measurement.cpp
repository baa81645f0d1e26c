#include "skyhalo/sensor_model/range_measurement.hpp"

#include <cmath>

namespace skyhalo {

bool is_valid(const RangeMeasurement& measurement) noexcept {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  const double range_m = measurement.range_m.value_or(measurement.max_range_m);
  return measurement.T_body_sensor.matrix().allFinite() && positive(measurement.half_angle_rad) &&
         measurement.half_angle_rad <= 0.5 * std::numbers::pi && positive(range_m) &&
         positive(measurement.max_range_m) && positive(measurement.delta_z_m);
}

}  // namespace skyhalo
