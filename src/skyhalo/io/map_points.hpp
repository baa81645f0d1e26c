#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "skyhalo/io/ply.hpp"
#include "skyhalo/map/occupancy.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// Cells whose probability is above this (in (0, 1)) are occupied, others of log odds below 0 free;
/// the rest, of which something is known but not enough, counts as unknown.
[[nodiscard]] OccupancyRule rule_of(double occupied_probability);

/// The most cells that are made points of (about 100 millions): some GiB of memory.
inline constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 27U;

/// An occupied cell as a point.
struct OccupiedPoint {
  Eigen::Vector3f center_m;  ///< map frame
  float probability;
};

/// The occupied cells, sorted by brick. Throws `Error` (failure) when there are more than
/// `kMostPoints`.
[[nodiscard]] std::vector<OccupiedPoint> occupied_points(const SparseMap& map,
                                                         const OccupancyRule& rule);

/// The points, coloured by height between the lowest and the highest of them.
[[nodiscard]] std::vector<ColouredPoint> coloured_by_height(
    const std::vector<OccupiedPoint>& points);

}  // namespace skyhalo
