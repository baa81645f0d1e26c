#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

namespace skyhalo {

/// Discards (NaN) the right-most `rcrop_px` columns, which can lie outside the left image: column j
/// stays iff `width - j > rcrop` (thesis eq. 5.1, corrected). An rcrop of at most 0 keeps all, one
/// of at least the width discards all.
void discard_right_columns(cv::Mat1f& disparity, int rcrop_px) noexcept;

/// Discards (NaN) every pixel that touches one of the rectangles, given in pixels of the image
/// before it was shrunk by `downscale`. Parts outside the image are ignored.
void discard_rectangles(cv::Mat1f& disparity, std::span<const cv::Rect> masks_px, int downscale);

/// Discards (NaN) every pixel that the right camera did not see, or whose match at column u + d the
/// left one did not. The masks are 255 where a camera saw something and have the disparity's size;
/// an empty one stands for everything.
void discard_unseen(cv::Mat1f& disparity,
                    const cv::Mat1b& right_valid,
                    const cv::Mat1b& left_valid) noexcept;

}  // namespace skyhalo
