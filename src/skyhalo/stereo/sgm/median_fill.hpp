#pragma once

#include <cstdint>

#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// What a median filter keeps between its two directions.
struct RowMedians {
  Plane<std::int16_t> median;
  Plane<std::int16_t> valid;  ///< how many of the five pixels have a disparity
};

/// First direction: the median of five neighbours along row v, which may be a margin's. Pixels
/// without a disparity (-1) stand for less than all or more than all, in turn like the fields of a
/// chessboard, so that they pull the median to neither side.
void median_along_row(const Plane<std::int16_t>& disparity_64, int v, RowMedians& rows) noexcept;

/// Second direction: of five rows, down the column. Fills pixels without a disparity where at least
/// `fill_min` of the 5 x 5 pixels have one.
void median_down_column(const Plane<std::int16_t>& disparity_64,
                        const RowMedians& rows,
                        int v,
                        int fill_min,
                        Plane<std::int16_t>& filled) noexcept;

}  // namespace skyhalo::sgm
