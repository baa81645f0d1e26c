#pragma once

#include <opencv2/core.hpp>

#include "skyhalo/camera/raw_pair.hpp"

namespace skyhalo {

/// The camera whose images are those of another one shrunk by a whole factor >= 1 by area
/// averaging (METHOD 1): the same lens with larger pixels. Rows and columns beyond a multiple of
/// the factor are left out.
[[nodiscard]] RawCamera downscaled(const RawCamera& camera, int factor);

/// The pixels of a shrunk image that share any with a rectangle of the whole one, in and beyond the
/// image; `factor` >= 1.
[[nodiscard]] cv::Rect downscaled(const cv::Rect& rectangle_px, int factor) noexcept;

}  // namespace skyhalo
