#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo::testing {

/// The first cell in which two maps differ, in words; empty if they hold the same.
inline std::string difference(const SparseMap& a, const SparseMap& b) {
  std::ostringstream text;
  if (!(a.lattice() == b.lattice())) {
    text << "lattices: " << a.lattice().origin_m.transpose() << ", " << a.lattice().voxel_m
         << " and " << b.lattice().origin_m.transpose() << ", " << b.lattice().voxel_m;
    return text.str();
  }
  for (const SparseMap* const map : {&a, &b}) {
    for (const Eigen::Vector3i& brick : map->bricks()) {
      for (std::size_t place = 0; place < kBrickCells; ++place) {
        const Eigen::Vector3i cell = cell_in_brick(brick, place);
        if (a.at(cell) != b.at(cell)) {
          text << "cell " << cell.transpose() << ": " << a.at(cell) << " and " << b.at(cell);
          return text.str();
        }
      }
    }
  }
  return "";
}

/// Bricks about the origin, half of them uniform, the rest with known and unknown cells.
inline SparseMap random_map(unsigned seed, int bricks, int reach = 20) {
  std::mt19937 random(seed);
  std::uniform_int_distribution place(-reach, reach);
  std::uniform_int_distribution value(-32767, 32767);
  SparseMap map({.origin_m = {-1.5, 2.25, 0.125}, .voxel_m = 0.25});
  for (int i = 0; i < bricks; ++i) {
    const Eigen::Vector3i brick(place(random), place(random), place(random));
    if (i % 2 == 0) {
      map.set_uniform(brick, static_cast<LogOdds>(value(random)));
      continue;
    }
    BrickCells cells{};
    for (LogOdds& cell : cells.cells) {
      cell = value(random) > 0 ? static_cast<LogOdds>(value(random)) : kUnknown;
    }
    map.set_brick(brick, cells);
  }
  return map;
}

}  // namespace skyhalo::testing
