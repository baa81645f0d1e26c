#pragma once

#include <opencv2/core/mat.hpp>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// How many pixels of a disparity image became points.
struct PixelCounts {
  int measured = 0;  ///< pixels with a disparity
  int used = 0;      ///< of these, the ones that see something within the range limits
};

/// One pair's geometry at the matched resolution.
struct PairGeometry {
  PairModel model;
  Pose T_body_camera = Pose::Identity();
  double min_range_m = 0.0;  ///< nearer points (from the camera) are left out, >= 0
  double max_range_m = 0.0;  ///< farther points (from the camera) are left out, > 0
};

/// Adds every valid pixel of a disparity image (px, NaN = none, aligned with the right image) to
/// the grid, as the point `T_body_camera * reproject(u, v, d)` (thesis eq. 5.2).
PixelCounts accumulate(const cv::Mat1f& disparity,
                       const PairGeometry& pair,
                       SphericalGrid& grid) noexcept;

}  // namespace skyhalo
