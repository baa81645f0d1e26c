#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace skyhalo::reference {

/// A rectified spherical pair (METHOD.md section 1): baseline in metres, size of a pixel in
/// radians, principal point of the right (reference) image in pixels; pixel centres are at
/// integers.
struct NaiveSphericalPair {
  long double baseline_m = 0.0L;
  long double pixel_u_rad = 0.0L;
  long double pixel_v_rad = 0.0L;
  long double u0_px = 0.0L;
  long double v0_px = 0.0L;
};

/// Right pixel (u, v) and disparity.
using NaiveMatch = std::array<long double, 3>;
using NaivePoint = std::array<long double, 3>;

inline NaivePoint naive_cross(const NaivePoint& a, const NaivePoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline long double naive_dot(const NaivePoint& a, const NaivePoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The ray at an angle alpha towards +x, in the half plane that is turned about the x axis (the
/// baseline) by beta from forward to down.
inline NaivePoint naive_spherical_ray(long double alpha_rad, long double beta_rad) {
  return {std::sin(alpha_rad),
          std::cos(alpha_rad) * std::sin(beta_rad),
          std::cos(alpha_rad) * std::cos(beta_rad)};
}

/// Triangulates a match: the point (m, right camera frame) midway between the closest points of the
/// right camera's ray, from the origin, and the left one's, from (-B, 0, 0). None where the rays
/// are parallel or meet behind a camera.
inline std::optional<NaivePoint> naive_spherical_point(const NaiveSphericalPair& pair,
                                                       const NaiveMatch& match) {
  const long double alpha = (match[0] - pair.u0_px) * pair.pixel_u_rad;
  const long double beta = (match[1] - pair.v0_px) * pair.pixel_v_rad;
  const long double delta = match[2] * pair.pixel_u_rad;
  const NaivePoint right = naive_spherical_ray(alpha, beta);
  const NaivePoint left = naive_spherical_ray(alpha + delta, beta);
  const NaivePoint to_left{-pair.baseline_m, 0.0L, 0.0L};
  const NaivePoint normal = naive_cross(right, left);
  const long double size = naive_dot(normal, normal);
  if (!(size > 0.0L)) {
    return std::nullopt;
  }
  const long double along_right = naive_dot(naive_cross(to_left, left), normal) / size;
  const long double along_left = naive_dot(naive_cross(to_left, right), normal) / size;
  if (!(along_right > 0.0L) || !(along_left > 0.0L)) {
    return std::nullopt;
  }
  NaivePoint point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = (along_right * right[axis] + to_left[axis] + along_left * left[axis]) / 2.0L;
  }
  return point;
}

/// Match of a point (m, right camera frame): the angle of the ray from each camera to the baseline.
inline NaiveMatch naive_spherical_match(const NaiveSphericalPair& pair, const NaivePoint& point) {
  const long double off_axis = std::hypot(point[1], point[2]);
  const long double alpha = std::atan2(point[0], off_axis);
  const long double alpha_left = std::atan2(point[0] + pair.baseline_m, off_axis);
  const long double beta = std::atan2(point[1], point[2]);
  return {alpha / pair.pixel_u_rad + pair.u0_px,
          beta / pair.pixel_v_rad + pair.v0_px,
          (alpha_left - alpha) / pair.pixel_u_rad};
}

/// Size of the change of the triangulated point, per axis and pixel of disparity, by a central
/// difference of fourth order.
inline NaivePoint naive_spherical_slope(const NaiveSphericalPair& pair, const NaiveMatch& match) {
  // Small against the angles at which the rays are parallel.
  const long double half_turn_px = std::numbers::pi_v<long double> / pair.pixel_u_rad;
  const long double step = 1e-3L * std::min(match[2], half_turn_px - match[2]);
  const auto at = [&](long double steps) {
    constexpr long double kNan = std::numeric_limits<long double>::quiet_NaN();
    return naive_spherical_point(pair, {match[0], match[1], match[2] + steps * step})
        .value_or(NaivePoint{kNan, kNan, kNan});
  };
  const NaivePoint next = at(1.0L);
  const NaivePoint last = at(-1.0L);
  const NaivePoint after = at(2.0L);
  const NaivePoint before = at(-2.0L);
  NaivePoint slope{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    slope[axis] =
        std::abs(8.0L * (next[axis] - last[axis]) - (after[axis] - before[axis])) / (12.0L * step);
  }
  return slope;
}

/// The smallest range (m) that any match of whole pixels in images of `width_px` columns has whose
/// disparity is at most `max_disparity_px` and whose left pixel lies in the image too.
inline long double naive_spherical_min_range_m(const NaiveSphericalPair& pair,
                                               int width_px,
                                               int max_disparity_px) {
  long double smallest = std::numeric_limits<long double>::infinity();
  for (int u = 0; u < width_px; ++u) {
    for (int d = 1; d <= max_disparity_px && u + d < width_px; ++d) {
      const NaiveMatch match{static_cast<long double>(u), pair.v0_px, static_cast<long double>(d)};
      if (const auto point = naive_spherical_point(pair, match)) {
        const long double range_m = std::sqrt(naive_dot(*point, *point));
        smallest = range_m < smallest ? range_m : smallest;
      }
    }
  }
  return smallest;
}

}  // namespace skyhalo::reference
