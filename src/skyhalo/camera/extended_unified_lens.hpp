#pragma once

#include <optional>

#include "skyhalo/camera/intrinsics.hpp"

namespace skyhalo {

/// The extended unified lens (Khomutenko, Garcia, Martinet 2016), `eucm`: with
/// `rho = sqrt(beta (x^2 + y^2) + z^2)` and `n = alpha rho + (1 - alpha) z`:
/// `(u, v) = (fx x/n + cx, fy y/n + cy)`.
///
/// Domain: the rays within `max_angle_rad` of the optical axis, a thousandth of a radian inside the
/// angle at which the image stands still or runs to infinity (z > -w rho of Usenko et al. 2018),
/// and below 179 degrees.
class ExtendedUnifiedLens {
 public:
  /// alpha in [0, 1] (0 is a pinhole) and beta above 0.
  struct Shape {
    double alpha = 0.5;
    double beta = 1.0;
  };

  /// Throws `Error` (input) naming `intrinsics_px` or `distortion` when a number is not finite or
  /// outside its domain.
  ExtendedUnifiedLens(const Intrinsics& intrinsics, const Shape& shape);

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
