#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// Row v without the pixels beside a step of more than `step_64` (0: none are dropped): there the
/// matched window saw both sides, and neither distance is sure. Drops pixels too whose match would
/// lie outside the other image. Writes pixels, or NaN, into `disparity_px`, whole vectors.
void drop_depth_edges(const Plane<std::int16_t>& disparity_64,
                      int v,
                      int step_64,
                      float* disparity_px) noexcept;

}  // namespace skyhalo::sgm
