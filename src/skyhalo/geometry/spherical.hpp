#pragma once

#include <Eigen/Core>
#include <cmath>

namespace skyhalo {

/// A point of the body frame in spherical coordinates (METHOD 3).
struct SphericalPoint {
  double rho_m = 0.0;      ///< distance from the body origin, >= 0
  double theta_rad = 0.0;  ///< polar angle in [0, pi]; 0 is up
  double phi_rad = 0.0;    ///< azimuth in [-pi, pi]; 0 is forward, positive to the left
};

/// Spherical coordinates of a body-frame point: `rho = |p|`, `theta = acos(z / rho)`,
/// `phi = atan2(y, x)` (thesis 5.3). The origin itself becomes rho 0, theta 0, phi 0; a point with
/// a NaN gives NaNs.
[[nodiscard]] inline SphericalPoint to_spherical(const Eigen::Vector3d& p_body_m) noexcept {
  const double rho_m = p_body_m.norm();
  if (rho_m == 0.0) {
    return {};
  }
  return {rho_m, std::acos(p_body_m.z() / rho_m), std::atan2(p_body_m.y(), p_body_m.x())};
}

/// Unit vector of the body frame in direction (theta, phi); the inverse of `to_spherical`.
[[nodiscard]] inline Eigen::Vector3d direction(double theta_rad, double phi_rad) noexcept {
  const double s = std::sin(theta_rad);
  return {s * std::cos(phi_rad), s * std::sin(phi_rad), std::cos(theta_rad)};
}

}  // namespace skyhalo
