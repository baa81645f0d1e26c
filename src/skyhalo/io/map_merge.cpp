#include "skyhalo/io/map_merge.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "skyhalo/io/map_lattice.hpp"

namespace skyhalo {
namespace {

constexpr int kMost = -1 - kUnknown;

LogOdds sum(LogOdds a, LogOdds b) noexcept {
  return b == kUnknown ? a : updated(a, b, kMost);
}

/// Changes all bricks: `change(value) -> value` for each cell.
template <class Change>
void change_cells(SparseMap& map, const Change& change) {
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  for (const Eigen::Vector3i& brick : map.bricks()) {
    if (const std::optional<LogOdds> value = map.uniform(brick)) {
      map.set_uniform(brick, change(*value));
      continue;
    }
    map.copy_brick(brick, cells);
    std::transform(cells.cells.begin(), cells.cells.end(), cells.cells.begin(), change);
    map.set_brick(brick, cells);
  }
}

/// Adds a map of the same lattice.
void add_bricks(SparseMap& map, const SparseMap& other) {
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the maps
  BrickCells more;   // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the maps
  for (const Eigen::Vector3i& brick : other.bricks()) {
    const std::optional<LogOdds> a = map.uniform(brick);
    const std::optional<LogOdds> b = other.uniform(brick);
    if (a && b) {
      map.set_uniform(brick, sum(*a, *b));
      continue;
    }
    map.copy_brick(brick, cells);
    other.copy_brick(brick, more);
    std::transform(
        cells.cells.begin(), cells.cells.end(), more.cells.begin(), cells.cells.begin(), sum);
    map.set_brick(brick, cells);
  }
}

}  // namespace

void add_log_odds(SparseMap& map, const SparseMap& other) {
  const Eigen::Vector3i offset = offset_to_same_cells(map.lattice(), other.lattice());
  if (offset.isZero()) {
    add_bricks(map, other);
  } else {
    add_bricks(map, moved_to(other, map.lattice(), offset));
  }
}

void limit_log_odds(SparseMap& map, int limit_units) {
  change_cells(map, [limit_units](LogOdds cell) {
    return cell == kUnknown ? cell : updated(cell, 0, limit_units);
  });
}

}  // namespace skyhalo
