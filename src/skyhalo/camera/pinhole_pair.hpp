#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace skyhalo {

/// A rectified pinhole stereo pair, seen from its right camera: pixel (u, v) of the right image
/// with disparity d matches pixel (u + d, v) of the left one. Pixel centres are at integers.
struct PinholePair {
  double focal_px = 0.0;             ///< f, > 0
  double principal_u_px = 0.0;       ///< u0
  double principal_v_px = 0.0;       ///< v0
  double baseline_m = 0.0;           ///< B, > 0; the left camera sits at (-B, 0, 0)
  double disparity_offset_px = 0.0;  ///< added to d where the two principal points differ in u
};

/// Unit vector (`cam`) of the ray of right-image pixel (u, v).
[[nodiscard]] inline Eigen::Vector3d ray_of(const PinholePair& pair,
                                            double u_px,
                                            double v_px) noexcept {
  return Eigen::Vector3d(u_px - pair.principal_u_px, v_px - pair.principal_v_px, pair.focal_px)
      .normalized();
}

/// The point (m, `cam`) that pixel (u, v) with disparity d sees (thesis eq. 4.1):
/// `((u-u0) B/d, (v-v0) B/d, f B/d)`. A disparity that is not above 0, offset included, gives NaN.
[[nodiscard]] inline Eigen::Vector3d reproject(const PinholePair& pair,
                                               double u_px,
                                               double v_px,
                                               double disparity_px) noexcept {
  const double d_px = disparity_px + pair.disparity_offset_px;
  const double m_per_px =
      d_px > 0.0 ? pair.baseline_m / d_px : std::numeric_limits<double>::quiet_NaN();
  return {(u_px - pair.principal_u_px) * m_per_px,
          (v_px - pair.principal_v_px) * m_per_px,
          pair.focal_px * m_per_px};
}

/// Right-image pixel (u, v) and disparity d, in that order, of a point (m, `cam`) with z > 0; the
/// inverse of `reproject`.
[[nodiscard]] inline Eigen::Vector3d project(const PinholePair& pair,
                                             const Eigen::Vector3d& point_m) noexcept {
  const double px_per_m = pair.focal_px / point_m.z();
  return {point_m.x() * px_per_m + pair.principal_u_px,
          point_m.y() * px_per_m + pair.principal_v_px,
          pair.baseline_m * px_per_m - pair.disparity_offset_px};
}

/// Size of the change of that point (m, per axis of `cam`) when d is wrong by `delta_d_px`
/// (thesis eq. 4.2), NaN unless d, offset included, is above 0: `(|u-u0|, |v-v0|, f) B/d^2
/// delta_d`.
[[nodiscard]] inline Eigen::Vector3d uncertainty_m(const PinholePair& pair,
                                                   const Eigen::Vector3d& pixel_and_disparity_px,
                                                   double delta_d_px) noexcept {
  const double d_px = pixel_and_disparity_px.z() + pair.disparity_offset_px;
  const double m_per_px = d_px > 0.0 ? pair.baseline_m / (d_px * d_px) * delta_d_px
                                     : std::numeric_limits<double>::quiet_NaN();
  return Eigen::Vector3d(pixel_and_disparity_px.x() - pair.principal_u_px,
                         pixel_and_disparity_px.y() - pair.principal_v_px,
                         pair.focal_px)
             .cwiseAbs() *
         m_per_px;
}

/// Range uncertainty straight ahead at range z (thesis eq. 6.9): `z^2 delta_d / (B f)`, in m.
[[nodiscard]] inline double delta_z_m(const PinholePair& pair,
                                      double z_m,
                                      double delta_d_px) noexcept {
  return z_m * z_m * delta_d_px / (pair.baseline_m * pair.focal_px);
}

/// The range straight ahead at which the uncertainty reaches `limit_m`; the inverse of `delta_z_m`.
[[nodiscard]] inline double range_at_uncertainty_m(const PinholePair& pair,
                                                   double limit_m,
                                                   double delta_d_px) noexcept {
  return std::sqrt(limit_m * pair.baseline_m * pair.focal_px / delta_d_px);
}

/// Range (m) straight ahead at disparity d, `f B/d`: the nearest thing that a search up to d finds
/// there, or the farthest that d still tells from infinity. Infinite where d, offset included, is
/// not above 0.
[[nodiscard]] inline double range_at_disparity_m(const PinholePair& pair,
                                                 double disparity_px) noexcept {
  const double d_px = disparity_px + pair.disparity_offset_px;
  return d_px > 0.0 ? pair.focal_px * pair.baseline_m / d_px
                    : std::numeric_limits<double>::infinity();
}

/// The smallest range (m) that a search up to `max_disparity_px` can measure anywhere in an image
/// of `width_px` columns: straight ahead, whatever the width.
[[nodiscard]] inline double min_range_m(const PinholePair& pair,
                                        [[maybe_unused]] int width_px,
                                        double max_disparity_px) noexcept {
  return range_at_disparity_m(pair, max_disparity_px);
}

/// The same pair for images shrunk by a whole factor s by area averaging (METHOD 1): f and the
/// disparity offset divided by s, `u0' = (u0 + 0.5)/s - 0.5`.
[[nodiscard]] inline PinholePair downscaled(const PinholePair& pair, int factor) noexcept {
  const double s = factor;
  return {pair.focal_px / s,
          (pair.principal_u_px + 0.5) / s - 0.5,
          (pair.principal_v_px + 0.5) / s - 0.5,
          pair.baseline_m,
          pair.disparity_offset_px / s};
}

}  // namespace skyhalo
