#pragma once

#include <random>
#include <vector>

#include "reference/naive_map_query.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo::testing {

/// Mostly free bricks of equal cells, some unknown ones, and some with single cells of all kinds;
/// `occupied` is the share of occupied cells among the latter.
template <class Map>
void fill_at_random(Map& map, const CellBox& box, double occupied, std::mt19937& rng) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for_each_cell(bricks_touching(box), [&](const Eigen::Vector3i& brick) {
    const double kind = share(rng);
    for_each_cell(overlap(box, cells_of(brick)), [&](const Eigen::Vector3i& cell) {
      const double at = share(rng);
      if (kind < 0.55) {
        map.set(cell, -700);
      } else if (kind > 0.6 && at < occupied) {
        map.set(cell, 900);
      } else if (kind > 0.6 && at < 0.97) {
        map.set(cell, at < 0.96 ? LogOdds{-400} : LogOdds{0});
      }
      return true;
    });
    return true;
  });
}

/// Stores bricks of equal cells as one number.
inline void merge_equal_cells(SparseMap& map) {
  for (const Eigen::Vector3i& brick : map.bricks()) {
    BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
    map.copy_brick(brick, cells);
    map.set_brick(brick, cells);
  }
}

/// 25 x 20 x 18 cells of 0.5 m.
inline DenseMap random_dense_map(double occupied, unsigned seed) {
  DenseMap map(VoxelGrid{{-3.1, 2.7, -4.4}, 0.5, {25, 20, 18}});
  std::mt19937 rng(seed);
  fill_at_random(map, map.bounds(), occupied, rng);
  return map;
}

/// 21 x 19 x 22 cells of 0.4 m, moved.
inline LocalMap random_local_map(double occupied, unsigned seed) {
  LocalMap map({21, 19, 22}, 0.4);
  map.follow({5.3, -2.2, 1.1});
  std::mt19937 rng(seed);
  fill_at_random(map, map.bounds(), occupied, rng);
  return map;
}

/// Some bricks round the origin, cells of 0.6 m.
inline SparseMap random_sparse_map(double occupied, unsigned seed) {
  SparseMap map(VoxelLattice{{0.2, -0.1, 0.3}, 0.6});
  std::mt19937 rng(seed);
  fill_at_random(map, {{-13, -9, -10}, {9, 12, 11}}, occupied, rng);
  merge_equal_cells(map);
  return map;
}

/// All cells of a map in a box, one by one.
template <class Map>
std::vector<reference::NaiveCell> cells_in(const Map& map, const CellBox& box) {
  std::vector<reference::NaiveCell> cells;
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      for (int z = box.min.z(); z < box.max.z(); ++z) {
        const Eigen::Vector3i index(x, y, z);
        const LogOdds value = map.at(index);
        cells.push_back({index,
                         map.lattice().origin_m + map.lattice().voxel_m * index.cast<double>(),
                         map.lattice().voxel_m,
                         value,
                         value != kUnknown});
      }
    }
  }
  return cells;
}

/// All cells that a map knows, and a rim of unknown ones about them.
template <class Map>
CellBox known_and_rim(const Map& map) {
  CellBox box = map.bounds();
  if constexpr (BrickMap<Map>) {
    box = map.known_bounds();
  }
  return {box.min.array() - 4, box.max.array() + 4};
}

/// A point anywhere in a box of cells (m, map frame).
inline Eigen::Vector3d random_point(const VoxelLattice& lattice,
                                    const CellBox& box,
                                    std::mt19937& rng) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Eigen::Vector3d at(share(rng), share(rng), share(rng));
  return lattice.corner_m(box.min) + lattice.voxel_m * at.cwiseProduct(box.size().cast<double>());
}

}  // namespace skyhalo::testing
