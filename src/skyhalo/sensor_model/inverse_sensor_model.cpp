#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

#include <numbers>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string("sensor_model.") + key + ": expected " + expected);
  }
}

/// c of thesis eq. 6.6: the two half-height points then lie symmetric about z when p_unknown = 0.5.
double width_behind(double a, double p_free, double delta_z_m) noexcept {
  const double denominator = a + 1.0 - 2.0 * p_free;
  if (!(a > 0.0) || !(denominator > 0.0)) {
    return 0.0;
  }
  return delta_z_m * std::sqrt(std::log1p(a / denominator) / std::numbers::ln2);
}

}  // namespace

void check(const SensorModelConfig& config) {
  require(config.k > 0.0 && config.k < 1.0, "k", "a number in (0, 1)");
  require(config.p_free > 0.0 && config.p_free <= 0.5, "p_free", "a probability in (0, 0.5]");
  require(config.p_unknown > config.p_free && config.p_unknown < 1.0,
          "p_unknown",
          "a probability in (p_free, 1)");
  require(config.delta_d_px > 0.0 && std::isfinite(config.delta_d_px),
          "delta_d_px",
          "a number of pixels above 0");
}

InverseSensorModel::InverseSensorModel(const SensorModelConfig& config,
                                       double z_m,
                                       double delta_z_m) noexcept
    : p_unknown_(config.p_unknown),
      p_free_(config.p_free),
      z_m_(z_m),
      delta_z_m_(delta_z_m),
      a_(config.k * (1.0 - config.p_unknown) * std::exp(-delta_z_m)),
      c_m_(width_behind(a_, config.p_free, delta_z_m)) {}

}  // namespace skyhalo
