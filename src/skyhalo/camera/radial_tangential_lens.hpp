#pragma once

#include <array>
#include <optional>

#include "skyhalo/camera/intrinsics.hpp"

namespace skyhalo {

/// The pinhole lens with radial and tangential distortion (Brown 1966), in the form and order of
/// OpenCV: with (x, y) = (X/Z, Y/Z), r^2 = x^2 + y^2 and
/// `g = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)`:
/// `u = fx (x g + 2 p1 x y + p2 (r^2 + 2 x^2)) + cx`, `v = fy (y g + p1 (r^2 + 2 y^2) + 2 p2 x y) +
/// cy`.
///
/// Domain: the rays within `max_angle_rad` of the optical axis, up to which the image grows
/// outwards in every direction at least a thousandth as fast as on the axis, and at most 89
/// degrees. Beyond, a calibrated polynomial folds back and shows a point twice.
class RadialTangentialLens {
 public:
  /// k1 k2 p1 p2 k3 k4 k5 k6; coefficients that a file leaves out are 0.
  using Distortion = std::array<double, 8>;

  /// Throws `Error` (input) naming `intrinsics_px` or `distortion` when a number is not finite, a
  /// focal length is not above 0, or the lens would show no field at all.
  RadialTangentialLens(const Intrinsics& intrinsics, const Distortion& distortion);

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
  double max_radius_;  // tan of it
};

}  // namespace skyhalo
