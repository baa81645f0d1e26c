#pragma once

namespace skyhalo {

/// Settings of the project's own Semi-Global Matching: the one place of its defaults, which serve
/// roads, rooms and forests alike. Costs are halves of census bits, 0...12; lengths are pixels of
/// the matched image.
struct SgmConfig {
  int p1 = 4;                  ///< penalty of a step of one disparity, >= 0
  int p2_min = 7;              ///< penalty of a larger step where the image has an edge, >= p1
  int p2_max = 48;             ///< the same where it has none, >= p2_min, <= 51
  int uniqueness_percent = 2;  ///< by how much the best sum must beat those not beside it, [0, 100]
  double left_right_px = 1.0;  ///< largest difference in the left-right check, [0, 256]
  int texture_min_grey = 2;    ///< least range of grey within 9 x 9 px, [0, 255]; 0: no check
  int repetition_px = 76;      ///< pixels of 9 x 9 that look repeated in the range and so make one
                               ///< unsure, [1, 82]; 82: no check
  int median_passes = 3;       ///< how often the 5 x 5 median is taken, [0, 10]
  int fill_min_px = 11;        ///< disparities among 5 x 5 that fill a hole; [1, 26], 26: never
  int speckle_size_px = 200;   ///< smaller islands are discarded, >= 0; 0: none
  double speckle_step_px = 0.75;  ///< a larger step parts islands, [0, 256]
  double edge_step_px = 3.0;      ///< pixels beside a larger step are dropped, [0, 256]; 0: none
};

}  // namespace skyhalo
