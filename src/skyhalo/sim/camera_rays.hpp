#pragma once

#include <Eigen/Core>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/camera/raw_pair.hpp"

namespace skyhalo {

/// Where a camera's pixels look: the rays through the corners of all pixels, exact by the lens, and
/// between them straight lines.
class CameraRays {
 public:
  explicit CameraRays(const RawCamera& camera);

  /// Of a camera whose images come rectified: the right one, or with `left` the left one.
  CameraRays(const PairModel& pair, const cv::Size& size_px, bool left);

  [[nodiscard]] const cv::Size& size_px() const noexcept { return size_px_; }

  /// Unit vector (camera frame) of the ray `x`, `y` (0...1) across pixel (row, col); zero where a
  /// corner of the pixel is outside the lens.
  [[nodiscard]] Eigen::Vector3f at(int row, int col, float x, float y) const noexcept;

  /// How wide a pixel looks (rad), in the middle of the image.
  [[nodiscard]] float pixel_rad() const noexcept { return pixel_rad_; }

 private:
  [[nodiscard]] const Eigen::Vector3f& corner(int row, int col) const noexcept {
    return corners_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_px_.width + 1) +
                    static_cast<std::size_t>(col)];
  }

  template <class RayOf>
  void fill(const RayOf& ray_of_corner);

  cv::Size size_px_;
  std::vector<Eigen::Vector3f> corners_;  // row-major; zero outside the lens
  float pixel_rad_ = 0.0F;
};

}  // namespace skyhalo
