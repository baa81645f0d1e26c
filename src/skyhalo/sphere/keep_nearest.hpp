#pragma once

#include <array>
#include <cstdint>

#include "skyhalo/sphere/depth_rule.hpp"

namespace skyhalo {

/// Rows of pixels are handled in vectors: their buffers hold a multiple of this many.
inline constexpr int kRowPadding = 64;

/// The smallest ranges (m) of a cell, rising; infinite where there are not so many.
struct alignas(32) NearestRanges {
  std::array<float, kMaxNearest> range_m;
};

/// A row of points: the cell of each and its range (m), readable up to the next multiple of
/// `kRowPadding`, where the points are in no cell.
struct CellRow {
  const std::int32_t* cells;
  const float* ranges_m;
  int count;
};

/// Takes in a row of points. `kept` and `bounds_m` have an entry for each cell, and `bounds_m` one
/// for points in no cell, which is minus infinity; it is the `rank`-th of a cell's ranges, in [1,
/// kMaxNearest], and farther points may be left out.
void keep_nearest(const CellRow& row, int rank, NearestRanges* kept, float* bounds_m) noexcept;

}  // namespace skyhalo
