#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace skyhalo {

/// A picture that repeats without end, in finer and coarser copies, so that far surfaces do not
/// flicker.
class Texture {
 public:
  /// From a picture of any size, which is scaled to a square with a power of two as its side, at
  /// most 2048. Throws `Error` (input) for an empty picture.
  explicit Texture(const cv::Mat3b& picture);

  /// Side of the finest copy (pixels).
  [[nodiscard]] int side_px() const noexcept { return side_px_; }

  /// Blue, green, red in 0...1 at (u, v), where 1 is a whole picture and v points down in it.
  /// `footprint` is the width of what is looked at, in the same unit. Total: what is not finite is
  /// taken as 0.
  [[nodiscard]] Eigen::Vector3f at(float u, float v, float footprint) const noexcept;

 private:
  int side_px_ = 0;
  std::vector<cv::Mat4b> levels_;  // the finest first, each of half the side
};

}  // namespace skyhalo
