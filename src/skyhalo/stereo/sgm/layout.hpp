#pragma once

#include <algorithm>
#include <cstddef>

namespace skyhalo::sgm {

/// Where pixels stand while costs are summed along paths. A vector's lanes are neighbouring rows,
/// each two columns behind the one above: at step t lane i holds column t - 2 i of row
/// strip * lanes + i. So the predecessors of all eight paths belong to earlier steps, and d +- 1 is
/// the next register. The strips of rows follow each other without a pause: lane i goes on with row
/// i + lanes one `period` of steps later.
struct SkewLayout {
  int width_px = 0;
  int height_px = 0;
  int disparities = 0;
  int lanes = 0;
  int period = 0;  ///< steps from one strip to the next; the gap between is never empty
  int strips = 0;
  int steps = 0;  ///< a multiple of 16

  SkewLayout() = default;

  SkewLayout(int width, int height, int max_disparity, int vector_lanes) noexcept
      : width_px(width),
        height_px(height),
        disparities(max_disparity),
        lanes(vector_lanes),
        period(std::max(width + 1, 2 * vector_lanes + 4)),
        strips((height + vector_lanes - 1) / vector_lanes),
        steps((strips * period + 2 * vector_lanes + 15) / 16 * 16) {}

  /// Values of one lane, strip after strip, with room for the shear at both ends.
  [[nodiscard]] std::ptrdiff_t lane_stride() const noexcept {
    const int size = lead() + steps + disparities + 64;
    return (size + 63) / 64 * 64 + 64;  // hardly ever a multiple of the page's size
  }

  [[nodiscard]] int lead() const noexcept { return 2 * lanes + 64; }

  /// Where row v begins in the rows of lanes.
  [[nodiscard]] std::ptrdiff_t row_offset(int v) const noexcept {
    return static_cast<std::ptrdiff_t>(v % lanes) * lane_stride() + lead() +
           static_cast<std::ptrdiff_t>(v / lanes) * period;
  }
};

}  // namespace skyhalo::sgm
