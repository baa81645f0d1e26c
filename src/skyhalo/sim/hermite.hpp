#pragma once

#include <Eigen/Core>

namespace skyhalo {

/// One interval of a cubic Hermite curve: the values and the slopes (per second) at both ends and
/// the time between them, more than 0.
struct HermiteInterval {
  Eigen::Vector3d value_0;
  Eigen::Vector3d slope_0;
  Eigen::Vector3d value_1;
  Eigen::Vector3d slope_1;
  double interval_s = 1.0;
};

/// The value at a fraction u of the interval, 0 to 1; at both ends exactly that of the end.
[[nodiscard]] inline Eigen::Vector3d hermite_value(const HermiteInterval& curve,
                                                   double u) noexcept {
  const double w = u * u * (3.0 - 2.0 * u);
  const double s0 = u * (1.0 - u) * (1.0 - u) * curve.interval_s;
  const double s1 = u * u * (u - 1.0) * curve.interval_s;
  return (1.0 - w) * curve.value_0 + w * curve.value_1 + s0 * curve.slope_0 + s1 * curve.slope_1;
}

/// The first derivative by time (per second).
[[nodiscard]] inline Eigen::Vector3d hermite_slope(const HermiteInterval& curve,
                                                   double u) noexcept {
  const double w = 6.0 * u * (1.0 - u) / curve.interval_s;
  const double s0 = (1.0 - u) * (1.0 - 3.0 * u);
  const double s1 = u * (3.0 * u - 2.0);
  return w * (curve.value_1 - curve.value_0) + s0 * curve.slope_0 + s1 * curve.slope_1;
}

/// The second derivative by time (per second^2).
[[nodiscard]] inline Eigen::Vector3d hermite_bend(const HermiteInterval& curve, double u) noexcept {
  const double h = curve.interval_s;
  const Eigen::Vector3d rise = (6.0 - 12.0 * u) / h * (curve.value_1 - curve.value_0);
  return (rise + (6.0 * u - 4.0) * curve.slope_0 + (6.0 * u - 2.0) * curve.slope_1) / h;
}

}  // namespace skyhalo
