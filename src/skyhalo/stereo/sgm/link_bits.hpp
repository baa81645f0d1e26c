#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// How a row hangs together, one bit a pixel, 64 pixels a word, pixel 0 in the lowest bit.
struct LinkBits {
  std::uint64_t* valid = nullptr;   ///< the pixel has a disparity
  std::uint64_t* across = nullptr;  ///< and so has the one before it, without a step
  std::uint64_t* down = nullptr;    ///< and so has the one above it, without a step
};

/// The bits of row v; two disparities are linked if they differ by at most `step_64`. Bits beyond
/// the row's end are 0; there must be room for two words more than the row has.
void find_links(const Plane<std::int16_t>& disparity_64,
                int v,
                int step_64,
                const LinkBits& bits) noexcept;

}  // namespace skyhalo::sgm
