#pragma once

#include <opencv2/core/mat.hpp>
#include <variant>

#include "skyhalo/stereo/matcher_config.hpp"
#include "skyhalo/stereo/opencv_sgbm.hpp"

namespace skyhalo {

/// Dense stereo matching behind one interface, whatever engine does it. Holds the engine's memory:
/// one object per pair; not for use by two threads at once.
class Matcher {
 public:
  /// Throws `Error` (input) naming the key when a setting is outside its domain.
  explicit Matcher(const MatcherConfig& config);

  /// Disparities (px) aligned with the right image: right pixel (u, v) matches left (u + d, v).
  /// NaN where there is none. `left` and `right` are rectified and of one size; `disparity` gets
  /// that size. The image must be wider than the largest disparity, or nothing is found.
  void match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity);

 private:
  std::variant<OpencvSgbm> engine_;
};

}  // namespace skyhalo
