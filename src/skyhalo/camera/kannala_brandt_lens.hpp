#pragma once

#include <array>
#include <optional>

#include "skyhalo/camera/intrinsics.hpp"

namespace skyhalo {

/// The fisheye lens of Kannala and Brandt 2006 with four coefficients; OpenCV's `fisheye`, Kalibr's
/// `equidistant`, Basalt's `kb4`. With theta the angle to the optical axis and (x, y)/rho the
/// direction across it: `(u, v) = (fx, fy) r(theta) (x, y)/rho + (cx, cy)`,
/// `r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)`.
///
/// Domain: the rays within `max_angle_rad` of the axis, up to which r grows at least a thousandth
/// as fast as on the axis; at most 179 degrees, so that a lens of more than 180 degrees sees points
/// behind the camera.
class KannalaBrandtLens {
 public:
  using Distortion = std::array<double, 4>;  ///< k1 k2 k3 k4

  /// Throws `Error` (input) naming `intrinsics_px` or `distortion` when a number is not finite or a
  /// focal length is not above 0.
  KannalaBrandtLens(const Intrinsics& intrinsics, const Distortion& distortion);

  [[nodiscard]] const Intrinsics& intrinsics() const noexcept { return intrinsics_; }

  [[nodiscard]] const Distortion& distortion() const noexcept { return distortion_; }

  [[nodiscard]] double max_angle_rad() const noexcept { return max_angle_rad_; }

  /// Pixel of a point (any scale, raw camera frame: x right, y down, z forward); none outside the
  /// domain and for a point that is not finite.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const noexcept;

  /// Derivative of `project`, where it has a value.
  [[nodiscard]] std::optional<LensJacobian> jacobian(const Eigen::Vector3d& point) const noexcept;

  /// Unit vector of the ray that a pixel sees; none when it lies outside the domain.
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject(
      const Eigen::Vector2d& pixel_px) const noexcept;

 private:
  Intrinsics intrinsics_;
  Distortion distortion_;
  double max_angle_rad_;
  double max_radius_;  // r of it
};

}  // namespace skyhalo
