#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skyhalo/sphere/grid_geometry.hpp"

namespace skyhalo {

// The way of a ball that leaves the body origin, against a thing in a cell of a spherical grid.

/// The largest angle between a cell's middle and a direction in it.
[[nodiscard]] inline double cell_radius_rad(const GridGeometry& grid) noexcept {
  return 0.5 * std::numbers::sqrt2 * std::max(grid.theta_step_rad, grid.phi_step_rad);
}

/// Cosine of the smallest angle to a direction from within `slack_rad` of one whose cosine to it is
/// given.
[[nodiscard]] inline double nearer_cosine(double cosine, double slack_rad) noexcept {
  const double c = std::clamp(cosine, -1.0, 1.0);
  const double slack_cosine = std::cos(slack_rad);
  return c >= slack_cosine ? 1.0 : c * slack_cosine + std::sqrt(1.0 - c * c) * std::sin(slack_rad);
}

/// A ball of no size still touches what is so near its way: rounding.
inline constexpr double kPointM = 1e-6;

/// How far a ball of radius r travels before it touches a point at `range_m`, seen at an angle of
/// this cosine from its way: `range cos - sqrt(r^2 - range^2 sin^2)`; infinite where it passes by
/// or moves away, 0 where it touches already.
[[nodiscard]] inline double travel_to_touch_m(double range_m,
                                              double cosine,
                                              double radius_m) noexcept {
  const double ball_m = std::max(radius_m, kPointM);
  const double aside_m2 = range_m * range_m * std::max(0.0, 1.0 - cosine * cosine);
  if (!(cosine > 0.0) || aside_m2 >= ball_m * ball_m) {
    return std::numeric_limits<double>::infinity();
  }
  return std::max(0.0, range_m * cosine - std::sqrt(ball_m * ball_m - aside_m2));
}

}  // namespace skyhalo
