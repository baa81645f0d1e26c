#pragma once

#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// Disparities (px) as 16-bit PNG files hold them: 256 times the disparity, rounded; 0 where there
/// is none (NaN). As 0 is taken, a disparity below 1/512 px becomes 1; one that 16 bits do not hold
/// becomes 65535 (255.996 px).
[[nodiscard]] cv::Mat1w disparity_image(const cv::Mat1f& disparity_px);

/// How many disparities (px) `disparity_image` cannot hold, as they are too large.
[[nodiscard]] int clipped_count(const cv::Mat1f& disparity_px) noexcept;

/// Disparities of images that were shrunk by a whole `factor` >= 1, in pixels and at the size of
/// the images before: each one, times the factor, fills its block. `size_px` holds all the blocks;
/// rows and columns beyond the last one become NaN.
[[nodiscard]] cv::Mat1f enlarged_disparity(const cv::Mat1f& disparity_px,
                                           int factor,
                                           const cv::Size& size_px);

}  // namespace skyhalo
