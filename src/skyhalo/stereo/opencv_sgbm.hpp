#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core/mat.hpp>

#include "skyhalo/stereo/matcher_config.hpp"

namespace skyhalo {

/// OpenCV's semi-global block matching. It aligns with its left input: for the right image both are
/// mirrored and exchanged, and the result is mirrored back.
class OpencvSgbm {
 public:
  /// Settings inside their domain (`Matcher` checks them).
  explicit OpencvSgbm(const MatcherConfig& config);

  /// See `Matcher::match`. The `max_disparity_px` columns at that side of the aligned image which
  /// the other image does not see stay empty: OpenCV does not match pixels whose search range
  /// leaves it.
  void match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity);

 private:
  bool align_left_;
  cv::Ptr<cv::StereoSGBM> sgbm_;
  cv::Mat mirrored_left_;
  cv::Mat mirrored_right_;
  cv::Mat fixed_;
};

}  // namespace skyhalo
