#pragma once

#include <algorithm>
#include <numbers>
#include <optional>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// What one range sensor that sees a cone says: a sonar, a radar, a single beam of light.
struct RangeMeasurement {
  Pose T_body_sensor = Pose::Identity();  ///< the beam goes along the sensor's x axis
  double half_angle_rad = 0.13;           ///< from the axis to the cone's rim, in (0, pi/2]
  std::optional<double> range_m;  ///< of the nearest echo; none = no echo up to `max_range_m`
  double max_range_m = 10.0;      ///< how far the sensor would have heard one, > 0
  double delta_z_m = 0.05;        ///< uncertainty of the range, > 0
};

/// Whether a measurement can be entered into a map: its numbers are finite and in their domain.
[[nodiscard]] bool is_valid(const RangeMeasurement& measurement) noexcept;

/// How much a place at an angle off the axis counts: 1 on the axis, 0 from the rim on, a parabola
/// between (Elfes 1989). Which place of the cone gave the echo is not known; the middle is
/// likeliest.
[[nodiscard]] inline double beam_weight(double angle_rad, double half_angle_rad) noexcept {
  const double share = angle_rad / half_angle_rad;
  return std::max(0.0, 1.0 - share * share);
}

}  // namespace skyhalo
