#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/rectify/remapper.hpp"

namespace skyhalo {

/// Rectified grey images at the resolution that is matched; both of one size.
struct RectifiedPair {
  cv::Mat1b left;
  cv::Mat1b right;
  cv::Mat1b left_valid;   ///< 255 where the raw camera saw something; empty when it did everywhere
  cv::Mat1b right_valid;  ///< likewise
};

/// Brings the images of a pair to the matched resolution: grey, 8 bit, rectified, shrunk by a whole
/// factor with area averaging. Raw images are warped to the virtual pair straight at that
/// resolution; images that come rectified are only shrunk. Rows and columns beyond a multiple of
/// the factor are left out at the bottom and right, so that `downscaled(model, factor)` describes
/// the result exactly. One object per pair; not for use by two threads at once.
class Rectifier {
 public:
  /// `factor` >= 1. Throws `Error` (input) when it is not, or leaves nothing of the pair's images.
  Rectifier(const StereoPair& pair, int factor);

  /// The pair at the matched resolution, valid until the next call. Throws `Error` (input) when the
  /// images are empty, have not the size that the pair says, or are neither 8 nor 16 bit with 1, 3
  /// or 4 channels.
  const RectifiedPair& rectify(const StereoImages& images);

 private:
  /// What one camera needs from frame to frame.
  struct Side {
    cv::Size size_px;  // of the images that come
    std::optional<Remapper> remapper;
    BlockMean block_mean;
    cv::Mat grey;
    cv::Mat grey_8bit;
  };

  void bring(const cv::Mat& image, Side& side, cv::Mat1b& out) const;

  int factor_;
  Side left_;
  Side right_;
  RectifiedPair pair_;
};

}  // namespace skyhalo
