#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core/mat.hpp>

#include "skyhalo/stereo/matcher_config.hpp"

namespace skyhalo {

/// OpenCV's semi-global block matching, turned to the right image. It aligns with its left input,
/// so both images are mirrored and exchanged, and the result is mirrored back.
class OpencvSgbm {
 public:
  /// Settings inside their domain (`Matcher` checks them).
  explicit OpencvSgbm(const MatcherConfig& config);

  /// See `Matcher::match`. The right-most `max_disparity_px` columns stay empty: OpenCV does not
  /// match pixels whose search range leaves the other image.
  void match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity);

 private:
  int max_disparity_px_;
  cv::Ptr<cv::StereoSGBM> sgbm_;
  cv::Mat mirrored_left_;
  cv::Mat mirrored_right_;
  cv::Mat mirrored_disparity_;
};

}  // namespace skyhalo
