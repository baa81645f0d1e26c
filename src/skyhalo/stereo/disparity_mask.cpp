#include "skyhalo/stereo/disparity_mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "skyhalo/base/whole_division.hpp"

namespace skyhalo {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The part [from, from + length) of a side of `size_px` before shrinking, after it, inside the
/// side.
cv::Range shrunk(int from, int length, int downscale, int size_px) noexcept {
  const std::int64_t end = std::int64_t{from} + length;  // may be beyond an int
  const auto inside = [size_px](std::int64_t at) {
    return static_cast<int>(std::clamp<std::int64_t>(at, 0, size_px));
  };
  return {inside(floor_div(from, downscale)), inside(ceil_div(end, downscale))};
}

/// Whether the left camera saw the match at column `u_px` (NaN for none) of row v.
bool sees_match(const cv::Mat1b& left_valid, int v, float u_px) noexcept {
  if (left_valid.empty()) {
    return true;
  }
  const float column = std::round(u_px);
  const bool inside = column >= 0.0F && column < static_cast<float>(left_valid.cols);
  return inside && left_valid(v, static_cast<int>(column)) != 0;
}

}  // namespace

void discard_right_columns(cv::Mat1f& disparity, int rcrop_px) noexcept {
  const int first = disparity.cols - std::clamp(rcrop_px, 0, disparity.cols);
  for (int v = 0; v < disparity.rows; ++v) {
    float* row = disparity[v];
    std::fill(row + first, row + disparity.cols, kNone);
  }
}

void discard_rectangles(cv::Mat1f& disparity, std::span<const cv::Rect> masks_px, int downscale) {
  for (const cv::Rect& mask : masks_px) {
    if (mask.empty()) {
      continue;
    }
    disparity(shrunk(mask.y, mask.height, downscale, disparity.rows),
              shrunk(mask.x, mask.width, downscale, disparity.cols))
        .setTo(kNone);
  }
}

void discard_unseen(cv::Mat1f& disparity,
                    const cv::Mat1b& right_valid,
                    const cv::Mat1b& left_valid) noexcept {
  for (int v = 0; v < disparity.rows; ++v) {
    float* row = disparity[v];
    for (int u = 0; u < disparity.cols; ++u) {
      const bool right_sees = right_valid.empty() || right_valid(v, u) != 0;
      if (!right_sees || !sees_match(left_valid, v, static_cast<float>(u) + row[u])) {
        row[u] = kNone;
      }
    }
  }
}

}  // namespace skyhalo
