#pragma once

namespace skyhalo {

/// Settings of OpenCV's semi-global block matching. Lengths are in pixels of the matched image.
struct OpencvSgbmConfig {
  int block_px = 3;             ///< side of the matched block, odd, in [1, 11]
  int paths = 3;                ///< aggregation paths: 3, 5 or 8
  int uniqueness_percent = 30;  ///< by how much the best cost must beat all others, [0, 100]
  int left_right_px = 1;        ///< largest difference in the left-right check, >= 1
  int speckle_size_px = 200;    ///< smaller islands of disparity are discarded; 0: none
  int speckle_range_px = 2;     ///< a step that parts islands, >= 0
};

}  // namespace skyhalo
