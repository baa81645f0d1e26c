#pragma once

#include <cstdint>

#include "skyhalo/stereo/opencv_sgbm_config.hpp"
#include "skyhalo/stereo/sgm_config.hpp"

namespace skyhalo {

/// Which engine finds the disparities.
enum class MatcherKind : std::uint8_t {
  kSgm,     ///< the project's own Semi-Global Matching
  kOpencv,  ///< OpenCV's semi-global block matching
};

/// Which image's pixels the disparities belong to.
enum class Alignment : std::uint8_t {
  kRight,  ///< right pixel (u, v) matches left (u + d, v)
  kLeft,   ///< left pixel (u, v) matches right (u - d, v)
};

/// Settings of stereo matching. Lengths are in pixels of the matched image.
struct MatcherConfig {
  MatcherKind kind = MatcherKind::kSgm;
  int max_disparity_px = 64;  ///< disparities 0 up to below this; a multiple of 16 in [16, 256]
  Alignment alignment = Alignment::kRight;
  SgmConfig sgm = {};
  OpencvSgbmConfig opencv = {};
};

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const MatcherConfig& config);

}  // namespace skyhalo
