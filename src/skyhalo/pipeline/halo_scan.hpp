#pragma once

#include <span>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "skyhalo/sphere/halo.hpp"

namespace skyhalo {

/// How uncertain a pair's ranges are.
struct RangeModel {
  PairModel pair;           ///< at the matched resolution
  double delta_d_px = 0.5;  ///< expected error of the disparity, > 0
};

/// Says in a scan what a halo knows: its depths, each with the range uncertainty of the pair that
/// it comes from (thesis eq. 6.9 to 6.11), and where it is free without a depth. `scan` has the
/// halo's rows; `models` has an entry for each of its sources, and depths of other sources are left
/// out.
void fill_scan(const Halo& halo, std::span<const RangeModel> models, RangeScan& scan) noexcept;

}  // namespace skyhalo
