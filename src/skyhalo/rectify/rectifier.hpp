#pragma once

#include <opencv2/core/mat.hpp>

#include "skyhalo/camera/stereo_rig.hpp"

namespace skyhalo {

/// Rectified grey images at the resolution that is matched; both of one size.
struct RectifiedPair {
  cv::Mat1b left;
  cv::Mat1b right;
};

/// Brings the images of an already rectified pair to the matched resolution: grey, 8 bit, shrunk by
/// a whole factor with area averaging. Rows and columns beyond a multiple of the factor are left
/// out at the bottom and right, so that `downscaled(model, factor)` describes the result exactly.
/// One object per pair; not for use by two threads at once.
class Rectifier {
 public:
  /// `factor` >= 1. Throws `Error` (input) otherwise.
  explicit Rectifier(int factor);

  /// The pair at the matched resolution, valid until the next call. Throws `Error` (input) when the
  /// images are empty, differ in size, or are neither 8 nor 16 bit with 1, 3 or 4 channels.
  const RectifiedPair& rectify(const StereoImages& images);

 private:
  void bring(const cv::Mat& image, cv::Mat1b& out);

  int factor_;
  cv::Mat grey_;
  cv::Mat grey_8bit_;
  RectifiedPair pair_;
};

}  // namespace skyhalo
