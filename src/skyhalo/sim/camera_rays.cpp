#include "skyhalo/sim/camera_rays.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/sim/pair_ray.hpp"

namespace skyhalo {

template <class RayOf>
void CameraRays::fill(const RayOf& ray_of_corner) {
  const auto cols = static_cast<std::size_t>(size_px_.width) + 1;
  const auto rows = static_cast<std::size_t>(size_px_.height) + 1;
  corners_.assign(rows * cols, Eigen::Vector3f::Zero());
  for_each_index(rows, [&](std::size_t row) {
    for (std::size_t col = 0; col < cols; ++col) {
      // Pixel centres are at whole numbers.
      const std::optional<Eigen::Vector3d> ray = ray_of_corner(
          Eigen::Vector2d(static_cast<double>(col) - 0.5, static_cast<double>(row) - 0.5));
      if (ray && ray->allFinite()) {
        corners_[row * cols + col] = ray->cast<float>();
      }
    }
  });
  const Eigen::Vector3f& middle = corner(size_px_.height / 2, size_px_.width / 2);
  const Eigen::Vector3f& beside = corner(size_px_.height / 2, size_px_.width / 2 + 1);
  pixel_rad_ = (beside - middle).norm();
}

CameraRays::CameraRays(const RawCamera& camera) : size_px_(camera.size_px) {
  fill([&](const Eigen::Vector2d& corner_px) { return unproject(camera.lens, corner_px); });
}

CameraRays::CameraRays(const PairModel& pair, const cv::Size& size_px, bool left)
    : size_px_(size_px) {
  // A point at infinity is in column u of the right image and u - offset of the left one.
  const auto* pinhole = std::get_if<PinholePair>(&pair);
  const double shift_px = left && pinhole != nullptr ? pinhole->disparity_offset_px : 0.0;
  fill([&](const Eigen::Vector2d& corner_px) {
    return std::optional(ray_or_zero(pair, {corner_px.x() + shift_px, corner_px.y()}));
  });
}

Eigen::Vector3f CameraRays::at(int row, int col, float x, float y) const noexcept {
  const Eigen::Vector3f& a = corner(row, col);
  const Eigen::Vector3f& b = corner(row, col + 1);
  const Eigen::Vector3f& c = corner(row + 1, col);
  const Eigen::Vector3f& d = corner(row + 1, col + 1);
  if (a.isZero(0.0F) || b.isZero(0.0F) || c.isZero(0.0F) || d.isZero(0.0F)) {
    return Eigen::Vector3f::Zero();
  }
  const Eigen::Vector3f top = a + x * (b - a);
  const Eigen::Vector3f bottom = c + x * (d - c);
  const Eigen::Vector3f ray = top + y * (bottom - top);
  return ray / std::max(ray.norm(), 1e-12F);
}

}  // namespace skyhalo
