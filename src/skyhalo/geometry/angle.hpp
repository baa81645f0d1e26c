#pragma once

#include <numbers>

namespace skyhalo {

/// Degrees (files and screens only) to radians.
[[nodiscard]] constexpr double rad_from_deg(double angle_deg) noexcept {
  return angle_deg * (std::numbers::pi / 180.0);
}

/// Radians to degrees (files and screens only).
[[nodiscard]] constexpr double deg_from_rad(double angle_rad) noexcept {
  return angle_rad * (180.0 / std::numbers::pi);
}

}  // namespace skyhalo
