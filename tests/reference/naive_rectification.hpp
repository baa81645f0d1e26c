#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>

#include "reference/naive_lens.hpp"

namespace skyhalo::reference {

/// Rows of a rotation matrix.
using NaiveRotation = std::array<NaiveVector, 3>;

/// The image to make from a raw one.
struct NaiveRectification {
  cv::Size matched_size_px;     ///< after shrinking
  int factor = 1;               ///< rectified pixels per matched pixel, along one side
  NaiveRotation R_raw_cam{};    ///< `cam` (virtual orientation) to the raw camera
  int rays_per_side = 8;        ///< rays per matched pixel, along one side
  double max_angle_rad = 3.14;  ///< the lens shows nothing farther from its axis
};

inline NaiveVector naive_rotated(const NaiveRotation& R, const NaiveVector& p) {
  NaiveVector q{};
  for (std::size_t row = 0; row < 3; ++row) {
    q[row] = R[row][0] * p[0] + R[row][1] * p[1] + R[row][2] * p[2];
  }
  return q;
}

/// Ray of a pixel of a rectified pinhole image (thesis eq. 4.1), of any length.
inline NaiveVector naive_pinhole_view(double focal_px,
                                      const NaiveImagePoint& principal_px,
                                      const NaiveImagePoint& pixel) {
  return {pixel[0] - principal_px[0], pixel[1] - principal_px[1], focal_px};
}

/// Ray of a pixel of a rectified spherical image (thesis eq. 4.3, corrected), with the size of a
/// pixel in radians.
inline NaiveVector naive_spherical_view(const std::array<double, 2>& pixel_rad,
                                        const NaiveImagePoint& principal_px,
                                        const NaiveImagePoint& pixel) {
  const double alpha = (pixel[0] - principal_px[0]) * pixel_rad[0];
  const double beta = (pixel[1] - principal_px[1]) * pixel_rad[1];
  return {std::sin(alpha), std::cos(alpha) * std::sin(beta), std::cos(alpha) * std::cos(beta)};
}

/// Linear interpolation between the four pixels round a place; none outside their centres.
inline std::optional<double> naive_bilinear(const cv::Mat1b& image, const NaiveImagePoint& at) {
  const double u = at[0];
  const double v = at[1];
  if (!(u >= 0.0 && v >= 0.0 && u <= image.cols - 1.0 && v <= image.rows - 1.0)) {
    return std::nullopt;
  }
  const int left = std::min(static_cast<int>(std::floor(u)), image.cols - 2);
  const int top = std::min(static_cast<int>(std::floor(v)), image.rows - 2);
  const double a = u - left;
  const double b = v - top;
  const double upper = (1.0 - a) * image(top, left) + a * image(top, left + 1);
  const double lower = (1.0 - a) * image(top + 1, left) + a * image(top + 1, left + 1);
  return (1.0 - b) * upper + b * lower;
}

/// Rectifies a raw image and shrinks it (METHOD 1): each matched pixel is the mean of rays that
/// are spread evenly over its square. `view` gives the ray of a pixel of the rectified image before
/// shrinking; a matched pixel at u' covers the rectified ones round `(u' + 1/2) factor - 1/2`.
/// `image_of` gives the raw pixel of a ray in the raw camera. NaN where any of the rays leaves the
/// raw image or the lens's field.
template <class View, class ImageOf>
cv::Mat1d naive_rectify(const cv::Mat1b& raw,
                        const NaiveRectification& goal,
                        const View& view,
                        const ImageOf& image_of) {
  const int n = goal.rays_per_side;
  const auto sample = [&](double u_matched, double v_matched) -> std::optional<double> {
    const NaiveImagePoint pixel{(u_matched + 0.5) * goal.factor - 0.5,
                                (v_matched + 0.5) * goal.factor - 0.5};
    const NaiveVector ray = naive_rotated(goal.R_raw_cam, view(pixel));
    if (std::atan2(std::hypot(ray[0], ray[1]), ray[2]) > goal.max_angle_rad) {
      return std::nullopt;
    }
    return naive_bilinear(raw, image_of(ray));
  };
  const auto mean = [&](int u, int v) {
    double sum = 0.0;
    for (int i = 0; i < n * n; ++i) {
      const int col = i % n;
      const int row = i / n;
      const std::optional<double> value =
          sample(u - 0.5 + (col + 0.5) / n, v - 0.5 + (row + 0.5) / n);
      if (!value) {
        return std::numeric_limits<double>::quiet_NaN();
      }
      sum += *value;
    }
    return sum / (n * n);
  };
  cv::Mat1d matched(goal.matched_size_px);
  for (int v = 0; v < matched.rows; ++v) {
    for (int u = 0; u < matched.cols; ++u) {
      matched(v, u) = mean(u, v);
    }
  }
  return matched;
}

}  // namespace skyhalo::reference
