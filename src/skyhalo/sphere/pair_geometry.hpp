#pragma once

#include <opencv2/core/types.hpp>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sphere/grid_geometry.hpp"

namespace skyhalo {

/// One pair's geometry at the matched resolution.
struct PairGeometry {
  PairModel model;
  Pose T_body_camera = Pose::Identity();
  double min_range_m = 0.0;  ///< nearer points (from the camera) are left out, >= 0
  double max_range_m = 0.0;  ///< farther points (from the camera) are left out, > 0
};

/// The part of `bounds` that the pair can have points in, with images of this size and things from
/// `near_m` (m, from the camera, > 0) on: whole rows and columns, a cell or more to spare; it may
/// cross the half-plane behind. Throws `Error` (input) when the bounds are none, when their step
/// does not divide a half turn, or when the pair sees nothing within them.
[[nodiscard]] GridGeometry grid_of_view(const PairGeometry& pair,
                                        const cv::Size& image_size_px,
                                        const GridBounds& bounds,
                                        double near_m);

}  // namespace skyhalo
