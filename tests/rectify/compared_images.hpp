#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <opencv2/core.hpp>
#include <ostream>

namespace skyhalo::testing {

/// How an image differs from what is expected of it.
struct Difference {
  int pixels = 0;
  double rms = 0.0;          ///< grey levels
  double mean_abs = 0.0;     ///< grey levels
  double brighter = 0.0;     ///< grey levels, fitted together with the shift
  Eigen::Vector2d shift_px;  ///< image(p) = expected(p + shift) + brighter, by least squares
};

inline std::ostream& operator<<(std::ostream& out, const Difference& difference) {
  return out << difference.pixels << " px, rms " << difference.rms << ", mean |difference| "
             << difference.mean_abs << ", brighter by " << difference.brighter << ", shift "
             << difference.shift_px.transpose() << " px";
}

/// Slope of an image (grey levels per px); NaN where a neighbour has no value.
inline Eigen::Vector2d slope_at(const cv::Mat1d& image, int u, int v) {
  return {0.5 * (image(v, u + 1) - image(v, u - 1)), 0.5 * (image(v + 1, u) - image(v - 1, u))};
}

/// Compares the pixels that are valid and whose surroundings have an expected value (not NaN).
inline Difference compare(const cv::Mat1b& image,
                          const cv::Mat1d& expected,
                          const cv::Mat1b& valid) {
  Difference result;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (int v = 1; v + 1 < image.rows; ++v) {
    for (int u = 1; u + 1 < image.cols; ++u) {
      const Eigen::Vector2d slope = slope_at(expected, u, v);
      const double wrong = image(v, u) - expected(v, u);
      if (valid(v, u) == 0 || !slope.allFinite() || !std::isfinite(wrong)) {
        continue;
      }
      ++result.pixels;
      squares += wrong * wrong;
      result.mean_abs += std::abs(wrong);
      const Eigen::Vector3d gradient(slope.x(), slope.y(), 1.0);
      H += gradient * gradient.transpose();
      right_side += gradient * wrong;
    }
  }
  result.rms = std::sqrt(squares / result.pixels);
  result.mean_abs /= result.pixels;
  const Eigen::Vector3d fitted = H.inverse() * right_side;
  result.shift_px = fitted.head<2>();
  result.brighter = fitted.z();
  return result;
}

/// Where the light of a window has its centre (px of the image).
inline Eigen::Vector2d centroid(const cv::Mat1b& image, const cv::Rect& window) {
  double sum = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (int v = window.y; v < window.y + window.height; ++v) {
    for (int u = window.x; u < window.x + window.width; ++u) {
      sum += image(v, u);
      moment += image(v, u) * Eigen::Vector2d(u, v);
    }
  }
  return moment / sum;
}

/// The square window round a place whose half side is `reach_px`.
inline cv::Rect window_round(const Eigen::Vector2d& place_px, int reach_px) {
  return {static_cast<int>(std::lround(place_px.x())) - reach_px,
          static_cast<int>(std::lround(place_px.y())) - reach_px,
          2 * reach_px + 1,
          2 * reach_px + 1};
}

}  // namespace skyhalo::testing
