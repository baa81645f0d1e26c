#pragma once

#include <cstddef>
#include <vector>

#include "map_contenders.hpp"

namespace skyhalo::bench {

/// What is true of the cells of a flight's world.
struct MapTruth {
  std::vector<Eigen::Vector3d> free_m;     ///< middles of cells that are free and could be seen
  std::vector<Eigen::Vector3d> surface_m;  ///< middles of cells that hold the end of a ray
};

/// The cells of the flight's bounds of size `voxel_m`; of more than some millions every n-th.
[[nodiscard]] MapTruth truth_of(const Flight& flight, double voxel_m);

/// How right a map is, as shares of 1.
struct MapScore {
  double free = 0.0;
  double surface_recall = 0.0;
  double false_occupied = 0.0;
};

[[nodiscard]] MapScore score(const Contender& map, const MapTruth& truth);

/// The definitions, as one paragraph.
inline constexpr const char* kScoreDefinitions =
    "Accuracy after the last scan. A cell is observable when its middle lies within 20 m of a "
    "scan's "
    "position and in\nline of sight of it (exact ray cast), and truly free when no surface touches "
    "its "
    "cube. free: share of the observable,\ntruly free cells that the map calls free. false: share "
    "of "
    "them that it calls occupied. surface: share of the cells\nthat hold the end point of at least "
    "one ray of a scan that it calls occupied. Of more than 3 million cells every n-th counts.\n";

}  // namespace skyhalo::bench
