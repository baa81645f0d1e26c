#include "skyhalo/io/disparity_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace skyhalo {
namespace {

constexpr float kUnitsPerPx = 256.0F;
constexpr float kLargest = std::numeric_limits<std::uint16_t>::max();

}  // namespace

cv::Mat1w disparity_image(const cv::Mat1f& disparity_px) {
  cv::Mat1w image(disparity_px.size());
  std::transform(disparity_px.begin(), disparity_px.end(), image.begin(), [](float d) {
    return std::isnan(d) ? std::uint16_t{0}
                         : static_cast<std::uint16_t>(
                               std::lround(std::clamp(d * kUnitsPerPx, 1.0F, kLargest)));
  });
  return image;
}

int clipped_count(const cv::Mat1f& disparity_px) noexcept {
  return static_cast<int>(std::count_if(disparity_px.begin(), disparity_px.end(), [](float d) {
    return d * kUnitsPerPx >= kLargest + 0.5F;
  }));
}

cv::Mat1f enlarged_disparity(const cv::Mat1f& disparity_px, int factor, const cv::Size& size_px) {
  cv::Mat1f enlarged(size_px, std::numeric_limits<float>::quiet_NaN());
  for (int v = 0; v < disparity_px.rows * factor; ++v) {
    const float* from = disparity_px[v / factor];
    float* to = enlarged[v];
    for (int u = 0; u < disparity_px.cols; ++u, to += factor) {
      std::fill_n(to, factor, from[u] * static_cast<float>(factor));
    }
  }
  return enlarged;
}

}  // namespace skyhalo
