#include "skyhalo/calibration/image_size.hpp"

#include <cmath>
#include <string>

namespace skyhalo {

int image_side_px(double value, const ErrorAt& error_at) {
  const bool fits = value >= 1.0 && value <= kLargestImageSide;
  if (!fits || std::trunc(value) != value) {
    throw error_at("expected a whole number of pixels in 1..." + std::to_string(kLargestImageSide));
  }
  return static_cast<int>(value);
}

cv::Size checked_image_size_px(const cv::Size& size_px, const ErrorAt& error_at) {
  return {image_side_px(size_px.width, error_at), image_side_px(size_px.height, error_at)};
}

}  // namespace skyhalo
