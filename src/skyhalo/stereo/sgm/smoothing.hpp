#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

// Rows [first, last) of an image's smoothed copies, margins included. `image` has its margins; each
// result is judged on its own margin afterwards. With avg(a, b) = (a + b + 1) / 2, which is one
// instruction everywhere:

/// cross = avg(centre, avg(avg(above, below), avg(left, right))).
void smooth_cross(const Plane<std::uint8_t>& image,
                  int first,
                  int last,
                  Plane<std::uint8_t>& cross);

/// Over 3 x 3 pixels, first along the row and then down the column: avg(centre, avg(side, side)).
void smooth_box(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& box);

/// The median of 3 x 3 pixels.
void median_3x3(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& median);

}  // namespace skyhalo::sgm
