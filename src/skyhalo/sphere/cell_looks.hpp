#pragma once

#include <limits>
#include <span>

namespace skyhalo {

/// How a pair's pixels looked into a cell's direction: each belongs to the cell of its own ray, as
/// if that began in the body origin, whatever it saw there.
struct CellLooks {
  int valid = 0;    ///< pixels with a disparity, also beyond the range limit
  int invalid = 0;  ///< pixels without, or that see something nearer than the limit
  float nearest_m =
      std::numeric_limits<float>::infinity();  ///< that a valid one sees, from the camera
};

/// Pixels [begin, end) of an image row that look into the same cell.
struct LookRun {
  int begin;
  int end;
  int cell;
};

/// Adds a row of pixels to the looks of cells: `seen_m` is the range that each sees from the
/// camera, infinite for far ones, and below 0 for invalid ones.
void add_row(const float* seen_m,
             std::span<const LookRun> runs,
             std::span<CellLooks> looks) noexcept;

}  // namespace skyhalo
