#pragma once

#include <cstdint>

#include "skyhalo/map/occupancy.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// What a map holds.
struct MapStatistics {
  std::uint64_t bricks = 0;
  std::uint64_t uniform_bricks = 0;  ///< of them, stored as one number
  std::uint64_t known_cells = 0;
  std::uint64_t free_cells = 0;
  std::uint64_t occupied_cells = 0;
  CellBox known;       ///< the smallest box that holds all known cells; empty for none
  LogOdds lowest = 0;  ///< log odds of the known cells; 0 for none
  LogOdds highest = 0;
};

[[nodiscard]] MapStatistics statistics_of(const SparseMap& map, const OccupancyRule& rule);

}  // namespace skyhalo
