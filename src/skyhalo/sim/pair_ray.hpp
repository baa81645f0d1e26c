#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "skyhalo/camera/pair_model.hpp"

namespace skyhalo {

/// Unit vector (`cam`) of the ray of a right-image pixel of a pair; zero where the pixel has none:
/// a quarter turn and more aside of a spherical pair's middle.
[[nodiscard]] inline Eigen::Vector3d ray_or_zero(const PairModel& pair,
                                                 const Eigen::Vector2d& pixel_px) noexcept {
  const auto* spherical = std::get_if<SphericalPair>(&pair);
  const double alpha_rad = spherical == nullptr ? 0.0
                                                : (pixel_px.x() - spherical->principal_u_px) *
                                                      spherical->delta_theta_u_rad;
  return std::abs(alpha_rad) < std::numbers::pi / 2.0 ? ray_of(pair, pixel_px.x(), pixel_px.y())
                                                      : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace skyhalo
