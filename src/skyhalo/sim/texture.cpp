#include "skyhalo/sim/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr int kLargestSidePx = 2048;

/// A coordinate within one picture, in [0, 1).
float within_one(float x) noexcept {
  return std::abs(x) < 1e6F ? x - std::floor(x) : 0.0F;
}

/// Which finer or coarser copy has pixels about as large as the footprint.
int level_of(float footprint_px, int level_count) noexcept {
  const float finite = std::isfinite(footprint_px) ? footprint_px : 0.0F;
  const float clamped = std::clamp(finite, 1.0F, 1e6F);
  return std::min(static_cast<int>(std::bit_width(static_cast<unsigned>(clamped))) - 1,
                  level_count - 1);
}

}  // namespace

Texture::Texture(const cv::Mat3b& picture) {
  if (picture.empty()) {
    throw Error(ErrorKind::kInput, "texture: the picture is empty");
  }
  const auto longest = static_cast<unsigned>(std::max(picture.cols, picture.rows));
  side_px_ = std::min(static_cast<int>(std::bit_ceil(longest)), kLargestSidePx);
  cv::Mat3b square;
  cv::resize(picture, square, cv::Size(side_px_, side_px_), 0.0, 0.0, cv::INTER_AREA);
  cv::Mat4b level;
  cv::cvtColor(square, level, cv::COLOR_BGR2BGRA);
  levels_.push_back(level.clone());
  for (int side_px = side_px_ / 2; side_px >= 1; side_px /= 2) {
    cv::Mat4b half;
    cv::resize(levels_.back(), half, cv::Size(side_px, side_px), 0.0, 0.0, cv::INTER_AREA);
    levels_.push_back(half);
  }
}

Eigen::Vector3f Texture::at(float u, float v, float footprint) const noexcept {
  const int level =
      level_of(footprint * static_cast<float>(side_px_), static_cast<int>(levels_.size()));
  const cv::Mat4b& copy = levels_[static_cast<std::size_t>(level)];
  const int side = copy.cols;
  const float x = within_one(u) * static_cast<float>(side) - 0.5F;
  const float y = within_one(v) * static_cast<float>(side) - 0.5F;
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const int mask = side - 1;  // sides are powers of two
  const auto pixel = [&](int row, int col) -> Eigen::Vector3f {
    const cv::Vec4b& p = copy(row & mask, col & mask);
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  };
  const Eigen::Vector3f top = (1.0F - fx) * pixel(y0, x0) + fx * pixel(y0, x0 + 1);
  const Eigen::Vector3f bottom = (1.0F - fx) * pixel(y0 + 1, x0) + fx * pixel(y0 + 1, x0 + 1);
  return ((1.0F - fy) * top + fy * bottom) * (1.0F / 255.0F);
}

}  // namespace skyhalo
