#pragma once

#include <cstdint>
#include <span>

#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// A map on one grid with exact cells. The lists hold an entry per cell of the grid, in its order.
struct MapAgainstExact {
  VoxelGrid grid;
  std::span<const LogOdds> map;
  std::span<const std::uint8_t> exact;    ///< 1: something is there
  std::span<const std::uint8_t> counted;  ///< 0: the cell is not asked for
};

/// How far a map is right where a cell beside the right one will do.
struct TolerantScore {
  std::int64_t claimed = 0;        ///< counted cells that the map calls occupied
  std::int64_t claimed_right = 0;  ///< with an exact cell among them and their 26 neighbours
  std::int64_t exact = 0;          ///< counted cells with something in them
  std::int64_t exact_found = 0;    ///< which, or a neighbour of which, the map calls occupied

  [[nodiscard]] double precision() const noexcept;  ///< NaN without a claimed cell
  [[nodiscard]] double recall() const noexcept;     ///< NaN without an exact cell
};

/// A cell is called occupied iff its probability is above `occupied_probability`. Neighbours need
/// not be counted themselves.
[[nodiscard]] TolerantScore tolerant_score(const MapAgainstExact& cells,
                                           double occupied_probability);

}  // namespace skyhalo
