#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "skyhalo/geometry/voxel_lattice.hpp"
#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// Maps change and are compared by bricks: cubes of 8 x 8 x 8 cells. Brick (a, b, c) holds the
/// cells from (8a, 8b, 8c) on.
inline constexpr int kBrickBits = 3;
inline constexpr int kBrickEdge = 1 << kBrickBits;
inline constexpr int kBrickCells = kBrickEdge * kBrickEdge * kBrickEdge;

/// One value per cell of a brick, z fastest, then y, then x.
struct alignas(64) BrickCells {
  std::array<LogOdds, kBrickCells> cells;
};

[[nodiscard]] inline Eigen::Vector3i brick_of(const Eigen::Vector3i& cell) noexcept {
  return {cell.x() >> kBrickBits, cell.y() >> kBrickBits, cell.z() >> kBrickBits};
}

/// The first cell of a brick.
[[nodiscard]] inline Eigen::Vector3i first_cell(const Eigen::Vector3i& brick) noexcept {
  return brick * kBrickEdge;
}

/// Position of a cell within its brick.
[[nodiscard]] inline std::size_t place_in_brick(const Eigen::Vector3i& cell) noexcept {
  constexpr int kMask = kBrickEdge - 1;
  const int place =
      (((cell.x() & kMask) << kBrickBits | (cell.y() & kMask)) << kBrickBits) | (cell.z() & kMask);
  return static_cast<std::size_t>(place);
}

/// The cell at a position within a brick; the inverse of `place_in_brick`.
[[nodiscard]] inline Eigen::Vector3i cell_in_brick(const Eigen::Vector3i& brick,
                                                   std::size_t place) noexcept {
  constexpr int kMask = kBrickEdge - 1;
  const int at = static_cast<int>(place);
  return first_cell(brick) +
         Eigen::Vector3i(at >> (2 * kBrickBits), (at >> kBrickBits) & kMask, at & kMask);
}

/// A brick in eighths: cubes of 4 x 4 x 4 cells, the unit that a sweep looks at as a whole.
inline constexpr int kEighthEdge = kBrickEdge / 2;
inline constexpr std::size_t kEighths = 8;
inline constexpr std::size_t kEighthCells = kBrickCells / kEighths;

/// The first cell of an eighth, from the brick's.
[[nodiscard]] inline Eigen::Vector3i first_of_eighth(std::size_t eighth) noexcept {
  const int at = static_cast<int>(eighth);
  return kEighthEdge * Eigen::Vector3i(at >> 2, (at >> 1) & 1, at & 1);
}

/// The eighth that holds the cell at a position within its brick.
[[nodiscard]] inline std::size_t eighth_at(std::size_t place) noexcept {
  return (place >> 8 & 1) << 2 | (place >> 5 & 1) << 1 | (place >> 2 & 1);
}

/// The bricks that hold at least one cell of a box, as a box of bricks.
[[nodiscard]] inline CellBox bricks_touching(const CellBox& cells) noexcept {
  return {brick_of(cells.min),
          brick_of(cells.max - Eigen::Vector3i::Ones()) + Eigen::Vector3i::Ones()};
}

/// Scans and cones change no cell that is farther than this many cells from the body: what one of
/// them may take of time and memory is bounded, whatever its ranges.
inline constexpr int kMostReachCells = 1024;

/// What a scan says of one cell: log odds to be added, in the cells' units. 0 = nothing.
using Increment = LogOdds;

/// Of what one scan says of a cell, in several places: what speaks for a thing beats what speaks
/// against it, and then the stronger counts. In any order the same.
[[nodiscard]] inline Increment stronger(Increment a, Increment b) noexcept {
  const Increment most = a > b ? a : b;
  const Increment least = a < b ? a : b;
  return most > 0 ? most : least;
}

}  // namespace skyhalo
