#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// Marks the pixels of row v with texture: 1 where brightest and darkest of 9 x 9 pixels differ by
/// at least `texture_min`, else 0. `image` has its margins.
void mark_texture(const Plane<std::uint8_t>& image,
                  int v,
                  int texture_min,
                  Plane<std::uint8_t>& textured);

}  // namespace skyhalo::sgm
