#include "skyhalo/io/map_statistics.hpp"

#include <algorithm>

#include "skyhalo/map/cell_map.hpp"

namespace skyhalo {
namespace {

void add(MapStatistics& sum, const CellBox& block, LogOdds value, Occupancy state) {
  const auto count = static_cast<std::uint64_t>(block.cell_count());
  const bool first = sum.known_cells == 0;
  sum.known.min = first ? block.min : sum.known.min.cwiseMin(block.min);
  sum.known.max = first ? block.max : sum.known.max.cwiseMax(block.max);
  sum.lowest = first ? value : std::min(sum.lowest, value);
  sum.highest = first ? value : std::max(sum.highest, value);
  sum.known_cells += count;
  sum.free_cells += state == Occupancy::kFree ? count : 0;
  sum.occupied_cells += state == Occupancy::kOccupied ? count : 0;
}

}  // namespace

MapStatistics statistics_of(const SparseMap& map, const OccupancyRule& rule) {
  MapStatistics sum;
  for (const Eigen::Vector3i& brick : map.bricks()) {
    ++sum.bricks;
    sum.uniform_bricks += map.uniform(brick) ? 1U : 0U;
    for_each_known_block_of(map, brick, cells_of(brick), [&](const CellBox& block, LogOdds value) {
      add(sum, block, value, rule(value));
      return true;
    });
  }
  return sum;
}

}  // namespace skyhalo
