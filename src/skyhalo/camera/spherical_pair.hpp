#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skyhalo {

/// A rectified spherical stereo pair, seen from its right camera (thesis 4.2): columns are angles
/// alpha = (u-u0) delta_theta_u towards +x, the baseline; rows are angles
/// beta = (v-v0) delta_theta_v about the baseline, so that a row is an epipolar plane. Pixel (u, v)
/// of the right image with disparity d matches pixel (u + d, v) of the left one.
struct SphericalPair {
  double delta_theta_u_rad = 0.0;  ///< width of a pixel, > 0
  double delta_theta_v_rad = 0.0;  ///< height of a pixel, > 0
  double principal_u_px = 0.0;     ///< u0
  double principal_v_px = 0.0;     ///< v0
  double baseline_m = 0.0;         ///< B, > 0; the left camera sits at (-B, 0, 0)
};

/// Unit vector (`cam`) of the ray of right-image pixel (u, v):
/// `(sin alpha, cos alpha sin beta, cos alpha cos beta)`; valid for |alpha| < pi/2.
[[nodiscard]] inline Eigen::Vector3d ray_of(const SphericalPair& pair,
                                            double u_px,
                                            double v_px) noexcept {
  const double alpha = (u_px - pair.principal_u_px) * pair.delta_theta_u_rad;
  const double beta = (v_px - pair.principal_v_px) * pair.delta_theta_v_rad;
  return {std::sin(alpha), std::cos(alpha) * std::sin(beta), std::cos(alpha) * std::cos(beta)};
}

/// The point (m, `cam`) that pixel (u, v) with disparity d sees (thesis eq. 4.3, 4.4, corrected):
/// `k ray(u, v)`, `k = B cos(alpha + delta)/sin(delta)`, `delta = d delta_theta_u`. NaN unless d >
/// 0 and |alpha|, |alpha + delta| < pi/2.
[[nodiscard]] inline Eigen::Vector3d reproject(const SphericalPair& pair,
                                               double u_px,
                                               double v_px,
                                               double disparity_px) noexcept {
  const double alpha = (u_px - pair.principal_u_px) * pair.delta_theta_u_rad;
  const double delta = disparity_px * pair.delta_theta_u_rad;
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const bool valid = delta > 0.0 && alpha > -kQuarter && alpha + delta < kQuarter;
  const double k_m = valid ? pair.baseline_m * std::cos(alpha + delta) / std::sin(delta)
                           : std::numeric_limits<double>::quiet_NaN();
  return k_m * ray_of(pair, u_px, v_px);
}

/// Right-image pixel (u, v) and disparity d, in that order, of a point (m, `cam`) off the
/// baseline's line; the inverse of `reproject`. beta reaches all round: points behind the cameras
/// too.
[[nodiscard]] inline Eigen::Vector3d project(const SphericalPair& pair,
                                             const Eigen::Vector3d& point_m) noexcept {
  const double across_m = std::hypot(point_m.y(), point_m.z());
  const double alpha = std::atan2(point_m.x(), across_m);
  const double beta = std::atan2(point_m.y(), point_m.z());
  // The difference of the two angles, without cancellation far away.
  const double delta =
      std::atan2(pair.baseline_m * across_m,
                 across_m * across_m + point_m.x() * (point_m.x() + pair.baseline_m));
  return {alpha / pair.delta_theta_u_rad + pair.principal_u_px,
          beta / pair.delta_theta_v_rad + pair.principal_v_px,
          delta / pair.delta_theta_u_rad};
}

/// Size of the change of that point (m, per axis of `cam`) when d is wrong by `delta_d_px` (thesis
/// eq. 4.7), NaN unless d > 0: `B cos(alpha) delta_theta_u (1 + 1/tan^2(delta)) delta_d |ray(u,
/// v)|`.
[[nodiscard]] inline Eigen::Vector3d uncertainty_m(const SphericalPair& pair,
                                                   const Eigen::Vector3d& pixel_and_disparity_px,
                                                   double delta_d_px) noexcept {
  const Eigen::Vector3d ray = ray_of(pair, pixel_and_disparity_px.x(), pixel_and_disparity_px.y());
  const double delta = pixel_and_disparity_px.z() * pair.delta_theta_u_rad;
  const double s = delta > 0.0 && delta < std::numbers::pi
                       ? std::sin(delta)
                       : std::numeric_limits<double>::quiet_NaN();
  const double cos_alpha = std::hypot(ray.y(), ray.z());
  // 1 + 1/tan^2 = 1/sin^2
  return ray.cwiseAbs() *
         (pair.baseline_m * cos_alpha * pair.delta_theta_u_rad / (s * s) * delta_d_px);
}

/// Range uncertainty straight ahead at range z (thesis eq. 6.10, 6.11):
/// `B delta_theta_u (1 + (z/B)^2) delta_d`, in m.
[[nodiscard]] inline double delta_z_m(const SphericalPair& pair,
                                      double z_m,
                                      double delta_d_px) noexcept {
  const double ratio = z_m / pair.baseline_m;
  return pair.baseline_m * pair.delta_theta_u_rad * (1.0 + ratio * ratio) * delta_d_px;
}

/// The range straight ahead at which the uncertainty reaches `limit_m`; the inverse of `delta_z_m`.
/// 0 when it is larger everywhere.
[[nodiscard]] inline double range_at_uncertainty_m(const SphericalPair& pair,
                                                   double limit_m,
                                                   double delta_d_px) noexcept {
  const double ratio2 = limit_m / (pair.baseline_m * pair.delta_theta_u_rad * delta_d_px) - 1.0;
  return ratio2 > 0.0 ? pair.baseline_m * std::sqrt(ratio2) : 0.0;
}

/// Range (m) straight ahead at disparity d, `B/tan(delta)`: the nearest thing that a search up to d
/// finds there, or the farthest that d still tells from infinity. 0 from a quarter turn on,
/// infinite where d is not above 0.
[[nodiscard]] inline double range_at_disparity_m(const SphericalPair& pair,
                                                 double disparity_px) noexcept {
  const double delta = disparity_px * pair.delta_theta_u_rad;
  if (!(delta > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  return delta < std::numbers::pi / 2.0 ? pair.baseline_m / std::tan(delta) : 0.0;
}

/// The smallest range (m) that a search up to `max_disparity_px` can measure anywhere in an image
/// of `width_px` columns: at one of its sides, where the baseline is seen most askew.
[[nodiscard]] inline double min_range_m(const SphericalPair& pair,
                                        int width_px,
                                        double max_disparity_px) noexcept {
  const double first = -pair.principal_u_px * pair.delta_theta_u_rad;
  const double last = (width_px - 1 - pair.principal_u_px) * pair.delta_theta_u_rad;
  const double delta = std::min(max_disparity_px * pair.delta_theta_u_rad, last - first);
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const auto range_m = [&](double left_alpha, double parallax) {
    return pair.baseline_m * std::cos(std::clamp(left_alpha, -kQuarter, kQuarter)) /
           std::sin(parallax);
  };
  // Of the left camera's last column, where a parallax of a quarter turn is the nearest, and of the
  // right camera's first one.
  return std::max(
      0.0, std::min(range_m(last, std::min(delta, kQuarter)), range_m(first + delta, delta)));
}

/// The same pair for images shrunk by a whole factor s by area averaging (METHOD 1): delta_theta
/// times s, `u0' = (u0 + 0.5)/s - 0.5`.
[[nodiscard]] inline SphericalPair downscaled(const SphericalPair& pair, int factor) noexcept {
  const double s = factor;
  return {pair.delta_theta_u_rad * s,
          pair.delta_theta_v_rad * s,
          (pair.principal_u_px + 0.5) / s - 0.5,
          (pair.principal_v_px + 0.5) / s - 0.5,
          pair.baseline_m};
}

}  // namespace skyhalo
