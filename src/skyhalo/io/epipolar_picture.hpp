#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

namespace skyhalo {

/// A point found in both images of a rectified pair.
struct PairMatch {
  cv::Point2d right_px;       ///< pixel of the right image
  double disparity_px = 0.0;  ///< u left - u right
  double dv_px = 0.0;         ///< v left - v right; 0 in a perfect pair
};

/// Both images of a rectified pair side by side, the left one on the left, pixel for pixel, with a
/// thin line across both at every `line_step_px`-th row (none for 0) and the row's number at its
/// start: what lies on a line in one image must lie on it in the other. Matches are dots in both
/// images, blue where their rows differ by less than half a pixel, yellow below one, else red; 24
/// of them from top to bottom are joined. The images have the same size.
[[nodiscard]] cv::Mat3b epipolar_picture(const cv::Mat1b& left,
                                         const cv::Mat1b& right,
                                         int line_step_px,
                                         std::span<const PairMatch> matches = {});

}  // namespace skyhalo
