#pragma once

#include <optional>

#include "skyhalo/camera/intrinsics.hpp"

namespace skyhalo {

/// The double sphere lens (Usenko, Demmel, Cremers 2018, section 4): with d1 = |p|,
/// `d2 = sqrt(x^2 + y^2 + (xi d1 + z)^2)` and `n = alpha d2 + (1 - alpha)(xi d1 + z)`:
/// `(u, v) = (fx x/n + cx, fy y/n + cy)`.
///
/// Domain: the rays within `max_angle_rad` of the optical axis, a thousandth of a radian inside the
/// angle at which the image stands still or runs to infinity, and below 179 degrees. That angle is
/// `psi + asin(xi sin(psi))`, `psi = acos(-w1)`; the paper's bound z > -w2 d1 differs from it, and
/// for a negative xi with alpha near 0 or 1 lies beyond it.
class DoubleSphereLens {
 public:
  /// The two spheres: the shift xi in (-1, 1] between them, and alpha in [0, 1].
  struct Shape {
    double xi = 0.0;
    double alpha = 0.5;
  };

  /// Throws `Error` (input) naming `intrinsics_px` or `distortion` when a number is not finite or
  /// outside its domain.
  DoubleSphereLens(const Intrinsics& intrinsics, const Shape& shape);

  [[nodiscard]] const Intrinsics& intrinsics() const noexcept { return intrinsics_; }

  [[nodiscard]] const Shape& shape() const noexcept { return shape_; }

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
  Shape shape_;
  double max_angle_rad_ = 0.0;
};

}  // namespace skyhalo
