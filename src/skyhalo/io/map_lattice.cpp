#include "skyhalo/io/map_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"

namespace skyhalo {
namespace {

using Places = std::vector<Eigen::Vector3i>;

constexpr int kBrickReach = VoxelLattice::kReach / kBrickEdge;

bool is_numbered(const Eigen::Vector3i& brick) {
  return (brick.array() >= -kBrickReach).all() && (brick.array() < kBrickReach).all();
}

/// The bricks that may hold cells of the map's bricks after they were moved.
Places bricks_after(const SparseMap& map, const Eigen::Vector3i& offset) {
  Places places;
  for (const Eigen::Vector3i& brick : map.bricks()) {
    const Eigen::Vector3i first = first_cell(brick) + offset;
    const CellBox touched = bricks_touching({first, first + Eigen::Vector3i::Constant(kBrickEdge)});
    for (int x = touched.min.x(); x < touched.max.x(); ++x) {
      for (int y = touched.min.y(); y < touched.max.y(); ++y) {
        for (int z = touched.min.z(); z < touched.max.z(); ++z) {
          places.emplace_back(x, y, z);
        }
      }
    }
  }
  std::sort(places.begin(), places.end(), before);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

Error too_far_apart() {
  return {ErrorKind::kInput, "the maps are too far apart: their cells cannot be numbered together"};
}

std::string vector_text(const Eigen::Array3d& v) {
  return "(" + number_text("%.6g", v.x()) + ", " + number_text("%.6g", v.y()) + ", " +
         number_text("%.6g", v.z()) + ")";
}

/// The value that all cells of some bricks share, if they do.
std::optional<LogOdds> uniform(const SparseMap& map, const CellBox& bricks) {
  const std::optional<LogOdds> value = map.uniform(bricks.min);
  for (int x = bricks.min.x(); value && x < bricks.max.x(); ++x) {
    for (int y = bricks.min.y(); y < bricks.max.y(); ++y) {
      for (int z = bricks.min.z(); z < bricks.max.z(); ++z) {
        if (map.uniform({x, y, z}) != value) {
          return std::nullopt;
        }
      }
    }
  }
  return value;
}

/// Fills a brick of the result from the (at most eight) bricks of the map that it lies across.
void fill(const SparseMap& map,
          const Eigen::Vector3i& brick,
          const Eigen::Vector3i& offset,
          SparseMap& result) {
  const Eigen::Vector3i first = first_cell(brick) - offset;
  const CellBox sources = bricks_touching({first, first + Eigen::Vector3i::Constant(kBrickEdge)});
  if (const std::optional<LogOdds> value = uniform(map, sources)) {
    result.set_uniform(brick, *value);
    return;
  }
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  if (sources.cell_count() == 1) {
    map.copy_brick(sources.min, cells);
  } else {
    for (std::size_t place = 0; place < cells.cells.size(); ++place) {
      cells.cells[place] = map.at(cell_in_brick(brick, place) - offset);
    }
  }
  result.set_brick(brick, cells);
}

}  // namespace

bool before(const Eigen::Vector3i& a, const Eigen::Vector3i& b) noexcept {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

Eigen::Vector3i offset_to_same_cells(const VoxelLattice& a, const VoxelLattice& b) {
  constexpr double kSameEdge = 5e-6;
  constexpr double kWholeCells = 1e-3;
  if (!(std::abs(a.voxel_m - b.voxel_m) <= kSameEdge * a.voxel_m)) {
    throw Error(ErrorKind::kInput,
                "the maps have cells of different size: " + number_text("%g", a.voxel_m) +
                    " m and " + number_text("%g", b.voxel_m) + " m");
  }
  const Eigen::Array3d cells = ((b.origin_m - a.origin_m) / a.voxel_m).array();
  if (!((cells - cells.round()).abs() <= kWholeCells).all()) {
    throw Error(ErrorKind::kInput,
                "the maps' cells do not lie on each other: their origins are " +
                    vector_text(cells) + " cells apart, expected whole cells");
  }
  if ((cells.abs() > 2.0 * VoxelLattice::kReach).any()) {
    throw too_far_apart();
  }
  return cells.round().matrix().cast<int>();
}

std::optional<SparseMap> moved(const SparseMap& map,
                               const VoxelLattice& lattice,
                               const Eigen::Vector3i& offset) {
  SparseMap result(lattice);
  for (const Eigen::Vector3i& brick : bricks_after(map, offset)) {
    // Bricks beyond the last numbers, if any, must be free of known cells.
    fill(map, brick, offset, result);
    if (result.holds_brick(brick) && !is_numbered(brick)) {
      return std::nullopt;
    }
  }
  return result;
}

SparseMap moved_to(const SparseMap& map,
                   const VoxelLattice& lattice,
                   const Eigen::Vector3i& offset) {
  std::optional<SparseMap> result = moved(map, lattice, offset);
  if (!result) {
    throw too_far_apart();
  }
  return std::move(*result);
}

}  // namespace skyhalo
