#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>

#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// A grid of cells from above, x to the right and y up; `colour_of(x, y)` gives each column's
/// colour, `cell_px` is the side of a cell in the picture.
[[nodiscard]] cv::Mat3b picture_from_above(const VoxelGrid& grid,
                                           int cell_px,
                                           const std::function<cv::Vec3b(int x, int y)>& colour_of);

/// A disparity image in colour: bright is near, black is no measurement. The brightest colour
/// stands for the 99th percentile, so that a few wrong matches do not darken the rest.
[[nodiscard]] cv::Mat3b disparity_picture(const cv::Mat1f& disparity_px);

/// A grid unrolled as it is seen from the body: left is left, up is up; bright is near (on a scale
/// of 1/range), dark grey is no measurement. `cell_px` is the side of a cell in the picture.
[[nodiscard]] cv::Mat3b grid_picture(const SphericalGrid& grid, int cell_px);

/// The layer of a map at height z (m), seen from above with x to the right and y up: probability
/// from white (free) to black (occupied), unknown in a pale blue. `cell_px` is the side of a cell.
[[nodiscard]] cv::Mat3b slice_picture(const DenseMap& map, double z_m, int cell_px);

/// A map from above, x to the right and y up: columns with an occupied cell in the colour of the
/// highest one's height, seen free space white, unknown pale blue.
[[nodiscard]] cv::Mat3b top_picture(const DenseMap& map, double occupied_probability, int cell_px);

}  // namespace skyhalo
