#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/camera/raw_pair.hpp"
#include "skyhalo/rectify/block_mean.hpp"

namespace skyhalo {

/// Where a remapped image comes from and what it shows.
struct RemapGoal {
  RawCamera camera;           ///< that took the image
  Eigen::Matrix3d R_raw_cam;  ///< `cam` (virtual orientation) to the raw camera
  PairModel model;            ///< of the image to make, at its own resolution
  cv::Size size_px;           ///< of the image to make
};

/// Warps raw images of one camera to its virtual one, straight at the resolution that is matched:
/// for each pixel its ray, rotated into the raw camera, imaged by its lens, sampled (METHOD 1).
/// When the image shrinks, the raw one is first averaged over whole blocks about as large as a
/// pixel of the result, so that it hardly aliases; the rest is bilinear, at 1/128 px. The look-up
/// is built once; remapping does not allocate after the first image. Not for use by two threads at
/// once.
class Remapper {
 public:
  explicit Remapper(const RemapGoal& goal);

  /// Warps a grey image of the raw camera's size. Pixels that it does not show become 0.
  void remap(const cv::Mat1b& raw, cv::Mat1b& out);

  /// 255 where a pixel's whole surroundings lie in the raw image, else 0.
  [[nodiscard]] const cv::Mat1b& valid() const noexcept { return valid_; }

  /// Side of the blocks of the raw image that are averaged first; 1 for none.
  [[nodiscard]] int block_px() const noexcept { return block_px_; }

 private:
  /// Where a pixel comes from: the upper left of four neighbours in the shrunk image, and how far
  /// (1/128 px) it lies from it.
  struct Tap {
    std::int32_t offset = 0;
    std::uint8_t right = 0;
    std::uint8_t down = 0;
  };

  void sample(const cv::Mat1b& shrunk, cv::Mat1b& out) const noexcept;

  int block_px_ = 1;
  cv::Size shrunk_size_;
  std::vector<Tap> taps_;  // row by row; offsets for rows of shrunk_size_.width
  cv::Mat1b valid_;
  BlockMean block_mean_;
  cv::Mat1b shrunk_;
};

}  // namespace skyhalo
