#pragma once

#include <opencv2/core/types.hpp>

#include "skyhalo/calibration/rotation_input.hpp"

namespace skyhalo {

/// The widest and highest image that calibrations may be of (px).
inline constexpr int kLargestImageSide = 16384;

/// A width or a height that a file gives (px). Throws `error_at` for what is no whole number in
/// 1...16384. Internal to this layer, as all of this header.
[[nodiscard]] int image_side_px(double value, const ErrorAt& error_at);

/// The same of both sides of a size that is given beside the files.
[[nodiscard]] cv::Size checked_image_size_px(const cv::Size& size_px, const ErrorAt& error_at);

}  // namespace skyhalo
