#pragma once

#include <cstddef>
#include <cstdint>

namespace skyhalo::sgm {

/// Rows of lanes, each `row_stride` bytes after the one before.
struct LaneRows {
  std::uint8_t* first = nullptr;  ///< column 0 of lane 0
  std::ptrdiff_t stride = 0;
};

/// Vectors of lanes, each `stride` bytes after that of the step before.
struct LaneSteps {
  std::uint8_t* first = nullptr;  ///< lane 0 at step 0
  std::ptrdiff_t stride = 0;
};

/// Sixteen steps beginning with `step`: lane i gets column step - 2 i of its row. Vectors of more
/// than one lane have a multiple of 16; columns before the first are read too, and must be there.
void skew(const LaneRows& rows, int lanes, int step, const LaneSteps& steps) noexcept;

/// The way back: from sixteen steps beginning with `step` to the rows of the lanes.
void unskew(const LaneSteps& steps, int lanes, int step, const LaneRows& rows) noexcept;

}  // namespace skyhalo::sgm
