#pragma once

namespace skyhalo {

/// Which engine finds the disparities.
enum class MatcherKind {
  kOpencv,  ///< OpenCV's semi-global block matching
};

/// Settings of stereo matching. Lengths are in pixels of the matched image.
struct MatcherConfig {
  MatcherKind kind = MatcherKind::kOpencv;
  int max_disparity_px = 64;    ///< disparities 0 up to below this; a multiple of 16 in [16, 256]
  int block_px = 3;             ///< side of the matched block, odd, in [1, 11]
  int paths = 3;                ///< aggregation paths: 3, 5 or 8
  int uniqueness_percent = 30;  ///< by how much the best cost must beat all others, [0, 100]
  int left_right_px = 1;        ///< largest difference in the left-right check, >= 1
  int speckle_size_px = 200;    ///< smaller islands of disparity are discarded; 0: none
  int speckle_range_px = 2;     ///< a step that parts islands
};

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const MatcherConfig& config);

}  // namespace skyhalo
