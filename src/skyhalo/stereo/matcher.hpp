#pragma once

#include <opencv2/core/mat.hpp>
#include <variant>

#include "skyhalo/stereo/grey_images.hpp"
#include "skyhalo/stereo/matcher_config.hpp"
#include "skyhalo/stereo/opencv_sgbm.hpp"
#include "skyhalo/stereo/sgm_matcher.hpp"

namespace skyhalo {

/// Dense stereo matching behind one interface, whatever engine does it. Holds the engine's memory:
/// one object per pair; not for use by two threads at once.
class Matcher {
 public:
  /// Throws `Error` (input) naming the key when a setting is outside its domain.
  explicit Matcher(const MatcherConfig& config);

  /// Disparities (px) aligned with the right image (right pixel (u, v) matches left (u + d, v)), or
  /// with the left one if the configuration says so. NaN where there is none. `left` and `right`
  /// are rectified, of one size and type: grey or colour (BGR, BGRA), 8 or 16 bits; `disparity`
  /// gets that size. Throws `Error` (input) when they are not, or not wider than the search range,
  /// or beyond 32767 px a side; `Error` (failure) when there is not enough memory. Grey 8-bit
  /// images are referred to until the next pair.
  void match(const cv::Mat& left, const cv::Mat& right, cv::Mat1f& disparity);

 private:
  int max_disparity_px_;
  GreyImages grey_;
  std::variant<SgmMatcher, OpencvSgbm> engine_;
};

}  // namespace skyhalo
