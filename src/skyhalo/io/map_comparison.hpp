#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "skyhalo/map/occupancy.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// The largest difference of log odds between two maps, and where it is.
struct LargestDifference {
  int units = 0;                                       ///< of 0.001, never negative
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();  ///< of the first such cell
};

/// How two maps of the same cells differ.
struct MapComparison {
  /// Cells by what they are in the first (outer) and in the second map, by `Occupancy`: not known,
  /// free, occupied. Those that neither map knows anything of are not counted.
  std::array<std::array<std::uint64_t, 3>, 3> cells{};
  std::uint64_t known_in_both = 0;  ///< with log odds in both, whatever they are

  /// Cells occupied in both, as a share of those occupied in any; none if none is.
  std::optional<double> occupied_intersection_over_union;
  /// Pearson's correlation of the log odds of the cells known in both; none unless they vary.
  std::optional<double> correlation;
  /// Of the cells known in both; none if there are none.
  std::optional<LargestDifference> largest_difference;
};

/// Compares two maps. Throws `Error` (input) unless the cells of both are the same: equal voxels,
/// origins whole cells apart.
[[nodiscard]] MapComparison compare_maps(const SparseMap& a,
                                         const SparseMap& b,
                                         const OccupancyRule& rule);

}  // namespace skyhalo
