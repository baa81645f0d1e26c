#include "skyhalo/rectify/remapper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace skyhalo {
namespace {

/// Far outside every image, and inside the 16 bits of the map.
constexpr float kNowhere = -20000.0F;

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

bool inside(const cv::Vec2d& at, const cv::Size& size) noexcept {
  return at[0] >= 0.0 && at[1] >= 0.0 && at[0] <= size.width - 1.0 && at[1] <= size.height - 1.0;
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

}  // namespace

Remapper::Remapper(const RemapGoal& goal) : valid_(goal.size_px) {
  const cv::Mat2d raw = raw_coordinates(goal);
  const cv::Size raw_size = goal.camera.size_px;
  const int largest_block = std::min({raw_size.width, raw_size.height, 64});
  block_px_ = std::clamp(
      static_cast<int>(std::lround(median_footprint_px(raw, raw_size))), 1, largest_block);
  shrunk_size_ = {raw_size.width / block_px_, raw_size.height / block_px_};
  cv::Mat2f source(goal.size_px);
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u) {
      const cv::Vec2d at = (raw(v, u) + cv::Vec2d(0.5, 0.5)) / block_px_ - cv::Vec2d(0.5, 0.5);
      const bool seen = inside(at, shrunk_size_);
      valid_(v, u) = seen ? 255 : 0;
      source(v, u) = seen ? cv::Vec2f(at) : cv::Vec2f(kNowhere, kNowhere);
    }
  }
  cv::convertMaps(source, cv::noArray(), map_px_, map_fraction_, CV_16SC2);
}

void Remapper::remap(const cv::Mat1b& raw, cv::Mat1b& out) {
  if (block_px_ > 1) {
    const cv::Rect whole_blocks(cv::Point(), shrunk_size_ * block_px_);
    cv::resize(raw(whole_blocks), shrunk_, shrunk_size_, 0.0, 0.0, cv::INTER_AREA);
  }
  cv::remap(block_px_ > 1 ? shrunk_ : raw,
            out,
            map_px_,
            map_fraction_,
            cv::INTER_LINEAR,
            cv::BORDER_CONSTANT,
            cv::Scalar(0));
}

}  // namespace skyhalo
