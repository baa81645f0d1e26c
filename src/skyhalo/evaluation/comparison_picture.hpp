#pragma once

#include <opencv2/core/mat.hpp>

#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/map/dense_map.hpp"

namespace skyhalo {

/// The ground truth from above, x to the right and y up: columns with an occupied cell in the
/// colour of the highest one's height, others white. `cell_px` is the side of a cell in the
/// picture.
[[nodiscard]] cv::Mat3b truth_picture(const GroundTruth& truth, int cell_px);

/// Map against ground truth from above, both on one grid: a column is green where an occupied cell
/// was found, orange where one was only claimed, blue where one was only missed, else white.
[[nodiscard]] cv::Mat3b comparison_picture(const DenseMap& map,
                                           const GroundTruth& truth,
                                           double occupied_probability,
                                           int cell_px);

}  // namespace skyhalo
