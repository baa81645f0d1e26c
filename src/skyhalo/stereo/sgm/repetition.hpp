#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// Marks the pixels of row v that tell enough: 1 where there is texture and fewer than
/// `repetition_px` of 9 x 9 pixels look repeated within the search range, else 0. So nets, fences
/// and blank walls give no disparity. `repeated` has its margins.
void mark_confident(const Plane<std::uint8_t>& repeated,
                    const Plane<std::uint8_t>& textured,
                    int v,
                    int repetition_px,
                    Plane<std::uint8_t>& confident);

/// Takes back what was filled into a row where the image tells too little.
void keep_confident(const std::uint8_t* confident, int width, std::int16_t* disparity_64) noexcept;

}  // namespace skyhalo::sgm
