#include "skyhalo/rectify/remapper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace skyhalo {
namespace {

constexpr int kFraction = 128;  // steps between two pixels of the shrunk image

/// Raw coordinates (px) of each pixel of the result; NaN where the lens images nothing.
cv::Mat2d raw_coordinates(const RemapGoal& goal) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  cv::Mat2d raw(goal.size_px);
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u) {
      const Eigen::Vector3d ray = goal.R_raw_cam * ray_of(goal.model, u, v);
      const std::optional<Eigen::Vector2d> at = project(goal.camera.lens, ray);
      raw(v, u) = at ? cv::Vec2d(at->x(), at->y()) : cv::Vec2d(kNone, kNone);
    }
  }
  return raw;
}

/// Half a step of the look-up counts as inside: rounding must not cost an image its border.
bool inside(const cv::Vec2d& at, const cv::Size& size) noexcept {
  constexpr double kTolerance = 0.5 / kFraction;
  return at[0] >= -kTolerance && at[1] >= -kTolerance && at[0] <= size.width - 1.0 + kTolerance &&
         at[1] <= size.height - 1.0 + kTolerance;
}

/// The median over the image of a pixel's size on the raw one: the square root of the area between
/// its neighbours.
double median_footprint_px(const cv::Mat2d& raw, const cv::Size& raw_size) {
  std::vector<double> footprints;
  constexpr int kEvery = 4;
  for (int v = 0; v + 1 < raw.rows; v += kEvery) {
    for (int u = 0; u + 1 < raw.cols; u += kEvery) {
      const cv::Vec2d across = raw(v, u + 1) - raw(v, u);
      const cv::Vec2d down = raw(v + 1, u) - raw(v, u);
      const double area = std::abs(across[0] * down[1] - across[1] * down[0]);
      if (inside(raw(v, u), raw_size) && std::isfinite(area)) {
        footprints.push_back(std::sqrt(area));
      }
    }
  }
  if (footprints.empty()) {
    return 1.0;
  }
  const auto middle = footprints.begin() + static_cast<std::ptrdiff_t>(footprints.size() / 2);
  std::nth_element(footprints.begin(), middle, footprints.end());
  return *middle;
}

/// The side of the blocks that an image is averaged over: from a quarter more than one raw pixel a
/// pixel, so that what is finer than the result's pixels fades before it is sampled.
int block_for(double footprint_px) noexcept {
  return static_cast<int>(std::floor(footprint_px + 0.75));
}

}  // namespace

Remapper::Remapper(const RemapGoal& goal) : valid_(goal.size_px, 0) {
  const cv::Mat2d raw = raw_coordinates(goal);
  const cv::Size raw_size = goal.camera.size_px;
  const int largest_block = std::min({raw_size.width / 2, raw_size.height / 2, 64});
  block_px_ =
      std::clamp(block_for(median_footprint_px(raw, raw_size)), 1, std::max(1, largest_block));
  shrunk_size_ = {raw_size.width / block_px_, raw_size.height / block_px_};
  taps_.resize(valid_.total());
  if (shrunk_size_.width < 2 || shrunk_size_.height < 2) {
    return;  // nothing to interpolate between
  }
  auto tap = taps_.begin();
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u, ++tap) {
      const cv::Vec2d at = (raw(v, u) + cv::Vec2d(0.5, 0.5)) / block_px_ - cv::Vec2d(0.5, 0.5);
      if (!inside(at, shrunk_size_)) {
        continue;
      }
      valid_(v, u) = 255;
      const double x = std::clamp(at[0], 0.0, shrunk_size_.width - 1.0);
      const double y = std::clamp(at[1], 0.0, shrunk_size_.height - 1.0);
      const int left = std::min(static_cast<int>(x), shrunk_size_.width - 2);
      const int top = std::min(static_cast<int>(y), shrunk_size_.height - 2);
      *tap = {top * shrunk_size_.width + left,
              static_cast<std::uint8_t>(std::lround((x - left) * kFraction)),
              static_cast<std::uint8_t>(std::lround((y - top) * kFraction))};
    }
  }
}

void Remapper::remap(const cv::Mat1b& raw, cv::Mat1b& out) {
  out.create(valid_.size());
  if (shrunk_size_.width < 2 || shrunk_size_.height < 2) {
    out.setTo(0);
    return;
  }
  const bool rows_are_packed = raw.isContinuous();
  if (block_px_ == 1 && rows_are_packed) {
    sample(raw, out);
    return;
  }
  block_mean_.shrink(raw, block_px_, shrunk_);
  sample(shrunk_, out);
}

void Remapper::sample(const cv::Mat1b& shrunk, cv::Mat1b& out) const noexcept {
  const std::uint8_t* const pixels = shrunk[0];
  const int stride = shrunk_size_.width;
  const Tap* tap = taps_.data();
  for (int v = 0; v < out.rows; ++v) {
    std::uint8_t* const row = out[v];
    const std::uint8_t* const seen = valid_[v];
    for (int u = 0; u < out.cols; ++u, ++tap) {
      const std::uint8_t* const p = pixels + tap->offset;
      const int upper = p[0] * (kFraction - tap->right) + p[1] * tap->right;
      const int lower = p[stride] * (kFraction - tap->right) + p[stride + 1] * tap->right;
      const int sum = upper * (kFraction - tap->down) + lower * tap->down;
      constexpr int kUnit = kFraction * kFraction;
      row[u] = static_cast<std::uint8_t>((sum + kUnit / 2) / kUnit & seen[u]);
    }
  }
}

}  // namespace skyhalo
