#include "skyhalo/io/map_points.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/colour.hpp"
#include "skyhalo/map/cell_map.hpp"

namespace skyhalo {
namespace {

/// Visits the occupied cells as blocks of equal cells.
template <class Visit>
void for_each_occupied_block(const SparseMap& map, const OccupancyRule& rule, const Visit& visit) {
  for (const Eigen::Vector3i& brick : map.bricks()) {
    const CellBox cells = cells_of(brick);
    for_each_known_block_of(map, brick, cells, [&](const CellBox& block, LogOdds value) {
      if (rule(value) == Occupancy::kOccupied) {
        visit(block, value);
      }
      return true;
    });
  }
}

}  // namespace

OccupancyRule rule_of(double occupied_probability) {
  const double units = std::floor(log_odds(occupied_probability) / kLogOddsPerUnit);
  const auto above = static_cast<LogOdds>(units);
  return {.occupied_above = above, .free_below = std::min<LogOdds>(0, above)};
}

std::vector<OccupiedPoint> occupied_points(const SparseMap& map, const OccupancyRule& rule) {
  std::uint64_t count = 0;
  for_each_occupied_block(map, rule, [&](const CellBox& block, LogOdds /*value*/) {
    count += static_cast<std::uint64_t>(block.cell_count());
  });
  if (count > kMostPoints) {
    throw Error(ErrorKind::kFailure,
                "the map has " + std::to_string(count) + " occupied cells, at most " +
                    std::to_string(kMostPoints) + " can be made points of");
  }
  std::vector<OccupiedPoint> points;
  points.reserve(count);
  for_each_occupied_block(map, rule, [&](const CellBox& block, LogOdds value) {
    for_each_cell(block, [&](const Eigen::Vector3i& cell) {
      points.push_back(
          {map.lattice().center_m(cell).cast<float>(), static_cast<float>(probability_of(value))});
      return true;
    });
  });
  return points;
}

std::vector<ColouredPoint> coloured_by_height(const std::vector<OccupiedPoint>& points) {
  const auto by_height = [](const OccupiedPoint& a, const OccupiedPoint& b) {
    return a.center_m.z() < b.center_m.z();
  };
  const auto [lowest, highest] = std::minmax_element(points.begin(), points.end(), by_height);
  std::vector<ColouredPoint> coloured;
  coloured.reserve(points.size());
  for (const OccupiedPoint& point : points) {
    const double range_m = highest->center_m.z() - lowest->center_m.z();
    const double height_m = point.center_m.z() - lowest->center_m.z();
    coloured.push_back({point.center_m, scale_colour(range_m > 0.0 ? height_m / range_m : 0.5)});
  }
  return coloured;
}

}  // namespace skyhalo
