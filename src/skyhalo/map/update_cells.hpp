#pragma once

#include <cstddef>
#include <span>

#include "skyhalo/map/brick.hpp"

namespace skyhalo {

/// Up to a brick's edge of cells that follow each other in memory.
struct LogOddsRow {
  LogOdds* cells = nullptr;
  int place = 0;  ///< of the first one in its brick
  int count = 0;
};

/// Adds a brick's increments to rows of its cells (see `updated`; an increment of 0 leaves a cell
/// as it is). Values stay within +-limit, in [1, 32767]. Returns whether any cell has changed.
/// Vectors of the best instruction set; the same bits on each.
bool add_increments(std::span<const LogOddsRow> rows,
                    const BrickCells& increments,
                    int limit) noexcept;

/// The same with one increment for all cells.
bool add_increment(std::span<const LogOddsRow> rows, Increment increment, int limit) noexcept;

/// All cells of a brick: rows along z, `x_step` and `y_step` cells apart in memory.
struct LogOddsBlock {
  LogOdds* cells = nullptr;
  std::ptrdiff_t x_step = std::ptrdiff_t{kBrickEdge} * kBrickEdge;
  std::ptrdiff_t y_step = kBrickEdge;
};

/// The same for a whole brick, and faster.
bool add_increments(const LogOddsBlock& block, const BrickCells& increments, int limit) noexcept;
bool add_increment(const LogOddsBlock& block, Increment increment, int limit) noexcept;

}  // namespace skyhalo
