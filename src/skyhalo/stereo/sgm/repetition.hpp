#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// Counts the repeated pixels (1 each) among nine along row v. `repeated` has its margins.
void count_repeated(const Plane<std::uint8_t>& repeated, int v, Plane<std::uint8_t>& counts);

/// Marks the pixels of row v that tell enough: 1 where there is texture and fewer than
/// `repetition_px` of 9 x 9 pixels look repeated within the search range, else 0. So nets, fences
/// and blank walls give no disparity. `counts` has all its rows; beyond the image the border
/// counts.
void mark_confident(const Plane<std::uint8_t>& counts,
                    const Plane<std::uint8_t>& textured,
                    int v,
                    int repetition_px,
                    Plane<std::uint8_t>& confident);

/// Takes back what was filled into row v where the image tells too little.
void keep_confident(const Plane<std::uint8_t>& confident,
                    int v,
                    Plane<std::int16_t>& disparity_64) noexcept;

}  // namespace skyhalo::sgm
