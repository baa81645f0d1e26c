#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <vector>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/brick.hpp"

namespace skyhalo {

/// A map that can be asked cell by cell: the cells of `bounds()` of a lattice, unknown elsewhere.
template <class Map>
concept CellMap = requires(const Map& map, const Eigen::Vector3i& cell) {
  { map.lattice() } -> std::convertible_to<VoxelLattice>;
  { map.bounds() } -> std::convertible_to<CellBox>;
  { map.at(cell) } -> std::same_as<LogOdds>;
};

/// A map without bounds that holds some bricks of cells: nothing may go through all its cells.
template <class Map>
concept BrickMap = CellMap<Map> &&
    requires(const Map& map, const Eigen::Vector3i& brick, BrickCells& cells) {
  { map.known_bounds() } -> std::convertible_to<CellBox>;
  { map.bricks() } -> std::convertible_to<std::vector<Eigen::Vector3i>>;
  { map.uniform(brick) } -> std::same_as<std::optional<LogOdds>>;
  map.copy_brick(brick, cells);
};

/// A map that knows when its bricks changed.
template <class Map>
concept ChangingMap = CellMap<Map> && requires(const Map& map, const Eigen::Vector3i& brick) {
  { map.changed_at(brick) } -> std::convertible_to<std::uint64_t>;
};

/// Boxes of more bricks than this (2^31 cells) are not gone through brick by brick: of a map that
/// holds only some bricks, those are, which takes memory for their list.
inline constexpr double kManyBricks = 4194304.0;

/// The number of cells, or of bricks, in a box of any size.
[[nodiscard]] inline double count_of(const CellBox& box) noexcept {
  return box.size().cast<double>().prod();
}

/// Queries that look at fewer cells than this do not ask a map for `known_bounds()`.
inline constexpr double kFewCells = 65536.0;

/// A box that holds all cells of a map that are known, for a query that would look at `cell_count`
/// cells: narrower than the bounds where that is worth the search.
template <CellMap Map>
[[nodiscard]] CellBox search_bounds(const Map& map, double cell_count) {
  if constexpr (BrickMap<Map>) {
    if (cell_count > kFewCells) {
      return map.known_bounds();
    }
  }
  return map.bounds();
}

/// The cells of a brick.
[[nodiscard]] inline CellBox cells_of(const Eigen::Vector3i& brick) noexcept {
  const Eigen::Vector3i first = first_cell(brick);
  return {first, first.array() + kBrickEdge};
}

/// Visits the known cells of a brick within a box, as blocks of equal cells:
/// `visit(cells, value) -> bool`, false to stop. False when it was stopped.
template <CellMap Map, class Visit>
bool for_each_known_block_of(const Map& map,
                             const Eigen::Vector3i& brick,
                             const CellBox& box,
                             Visit&& visit) {
  const CellBox cells = overlap(box, cells_of(brick));
  const auto visit_cell = [&visit](const Eigen::Vector3i& cell, LogOdds value) {
    return value == kUnknown || visit(CellBox{cell, cell.array() + 1}, value);
  };
  if constexpr (BrickMap<Map>) {
    if (const std::optional<LogOdds> value = map.uniform(brick)) {
      return *value == kUnknown || cells.empty() || visit(cells, *value);
    }
    BrickCells values;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
    map.copy_brick(brick, values);
    return for_each_cell(cells, [&](const Eigen::Vector3i& cell) {
      return visit_cell(cell, values.cells[place_in_brick(cell)]);
    });
  } else {
    return for_each_cell(
        cells, [&](const Eigen::Vector3i& cell) { return visit_cell(cell, map.at(cell)); });
  }
}

/// Visits the known cells of a box, brick by brick, as blocks of equal cells:
/// `visit(cells, value) -> bool`, false to stop. False when it was stopped.
template <CellMap Map, class Visit>
bool for_each_known_block(const Map& map, const CellBox& box, Visit&& visit) {
  CellBox within = overlap(box, map.bounds());
  if (within.empty()) {
    return true;
  }
  if constexpr (BrickMap<Map>) {
    within = overlap(within, search_bounds(map, count_of(within)));
    if (within.empty()) {
      return true;
    }
    if (count_of(bricks_touching(within)) > kManyBricks) {
      for (const Eigen::Vector3i& brick : map.bricks()) {
        if (!for_each_known_block_of(map, brick, within, visit)) {
          return false;
        }
      }
      return true;
    }
  }
  return for_each_cell(bricks_touching(within), [&](const Eigen::Vector3i& brick) {
    return for_each_known_block_of(map, brick, within, visit);
  });
}

/// Visits the known cells of a box, brick by brick: `visit(cell, value)`.
template <CellMap Map, class Visit>
void for_each_known_cell(const Map& map, const CellBox& box, Visit&& visit) {
  for_each_known_block(map, box, [&visit](const CellBox& cells, LogOdds value) {
    return for_each_cell(cells, [&](const Eigen::Vector3i& cell) {
      visit(cell, value);
      return true;
    });
  });
}

/// Visits the bricks that changed after a tick of the map, each once: `visit(brick)`. 0 = all that
/// ever changed. A brick that a map forgot is not among them (`SparseMap::forgot_at`).
template <ChangingMap Map, class Visit>
void for_each_changed_brick(const Map& map, std::uint64_t since_tick, Visit&& visit) {
  const auto visit_changed = [&](const Eigen::Vector3i& brick) {
    if (map.changed_at(brick) > since_tick) {
      visit(brick);
    }
    return true;
  };
  if constexpr (BrickMap<Map>) {
    for (const Eigen::Vector3i& brick : map.bricks()) {
      visit_changed(brick);
    }
  } else if (!map.bounds().empty()) {
    for_each_cell(bricks_touching(map.bounds()), visit_changed);
  }
}

}  // namespace skyhalo
