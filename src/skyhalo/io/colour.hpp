#pragma once

#include <opencv2/core/types.hpp>

namespace skyhalo {

/// A colour for a share in [0, 1] (clamped; NaN counts as 0) on a scale from dark blue over green
/// to yellow whose lightness rises steadily, so that it reads the same to colour-blind eyes and in
/// print. In OpenCV's order: blue, green, red.
[[nodiscard]] cv::Vec3b scale_colour(double share) noexcept;

}  // namespace skyhalo
