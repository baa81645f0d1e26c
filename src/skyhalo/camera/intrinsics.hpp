#pragma once

#include <Eigen/Core>
#include <optional>

namespace skyhalo {

/// Focal lengths and principal point of a raw camera (px); pixel centres are at integers.
struct Intrinsics {
  double fx_px = 0.0;  ///< > 0
  double fy_px = 0.0;  ///< > 0
  double cx_px = 0.0;
  double cy_px = 0.0;
};

/// Throws `Error` (input) naming `intrinsics_px` when a number is not finite or a focal length is
/// not above 0.
void check(const Intrinsics& intrinsics);

/// How the pixel (u, v) moves with the point (m): rows u and v, columns x, y and z.
using LensJacobian = Eigen::Matrix<double, 2, 3>;

/// The point divided by its largest component, so that no square of it overflows or vanishes; the
/// image of a point depends on its direction alone. None for the origin and for what is not finite.
[[nodiscard]] inline std::optional<Eigen::Vector3d> scaled_to_one(
    const Eigen::Vector3d& point) noexcept {
  const double largest = point.cwiseAbs().maxCoeff();
  if (!point.allFinite() || !(largest > 0.0)) {
    return std::nullopt;
  }
  return Eigen::Vector3d(point / largest);
}

}  // namespace skyhalo
