#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "skyhalo/camera/intrinsics.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {

// What the two models that project by way of a sphere share.

/// w1 of Usenko et al. 2018: how far behind the sphere's centre the plane through its last visible
/// circle lies, for alpha in [0, 1].
[[nodiscard]] inline double tangent_height(double alpha) noexcept {
  return alpha <= 0.5 ? alpha / (1.0 - alpha) : (1.0 - alpha) / alpha;
}

/// A little inside the angle at which the image stands still or runs to infinity, where its inverse
/// is still exact; at most 179 degrees.
[[nodiscard]] inline double inside_edge_rad(double edge_rad) noexcept {
  return std::min(edge_rad, rad_from_deg(179.0)) - 1e-3;
}

/// True for points at most this angle from the optical axis.
[[nodiscard]] inline bool within(const Eigen::Vector3d& point, double max_angle_rad) noexcept {
  return std::atan2(std::hypot(point.x(), point.y()), point.z()) <= max_angle_rad;
}

/// The unit vector of a ray, where it lies within the angle by more than a rounding.
[[nodiscard]] inline std::optional<Eigen::Vector3d> ray_within(const Eigen::Vector3d& ray,
                                                               double max_angle_rad) noexcept {
  const std::optional<Eigen::Vector3d> scaled = scaled_to_one(ray);
  if (!scaled || !within(*scaled, max_angle_rad - 1e-12)) {
    return std::nullopt;
  }
  return scaled->normalized();
}

/// Derivative of `(fx x/n, fy y/n)` with the gradient `dn` of n.
[[nodiscard]] inline LensJacobian quotient_jacobian(const Eigen::Vector3d& p,
                                                    double n,
                                                    const Eigen::Vector3d& dn,
                                                    const Intrinsics& f) noexcept {
  LensJacobian J;
  J.row(0) = f.fx_px / n * (Eigen::Vector3d::UnitX() - p.x() / n * dn).transpose();
  J.row(1) = f.fy_px / n * (Eigen::Vector3d::UnitY() - p.y() / n * dn).transpose();
  return J;
}

}  // namespace skyhalo
