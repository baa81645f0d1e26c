#include "skyhalo/io/map_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/lattice_walk.hpp"

namespace skyhalo {
namespace {

Eigen::Vector3i place_of(const Tile& tile) {
  return {std::get<0>(tile), std::get<1>(tile), std::get<2>(tile)};
}

template <class Visit>
void for_each_brick(const Tile& tile, Visit&& visit) {
  const Eigen::Vector3i first = place_of(tile) * kTileBricks;
  for_each_cell({first, (first.array() + kTileBricks).matrix()}, [&](const Eigen::Vector3i& brick) {
    visit(brick);
    return true;
  });
}

/// Distance (m) from a point to a tile.
double distance_m(const Eigen::Vector3d& point_m,
                  const Eigen::Vector3i& tile,
                  const VoxelLattice& lattice) {
  const Eigen::Vector3d first_m = lattice.corner_m(first_cell(tile * kTileBricks));
  const Eigen::Vector3d end_m =
      first_m + Eigen::Vector3d::Constant(kTileBricks * kBrickEdge * lattice.voxel_m);
  return (point_m - point_m.cwiseMax(first_m).cwiseMin(end_m)).norm();
}

const MapTilesConfig& checked(const MapTilesConfig& config) {
  if (!(config.reach_m > 0.0) || !std::isfinite(config.reach_m) || config.limit_units < 1 ||
      config.limit_units > 32767) {
    throw Error(ErrorKind::kInput,
                "map tiles: expected a reach above 0 m and a limit of 1 to 32767 units");
  }
  return config;
}

/// The folder, which is there now.
const std::filesystem::path& made(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Error(ErrorKind::kFailure, folder.string() + ": cannot be made: " + error.message());
  }
  return folder;
}

/// What a tile's file says of it; none for a file whose head is damaged.
std::optional<SkymapHeader> readable_header(const std::filesystem::path& folder, const Tile& tile) {
  try {
    return read_tile_header(folder, tile);
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Renames a file so that it is neither read nor written any more, and never replaces another.
/// Returns its new name, empty when there is no such file.
std::filesystem::path set_aside(const std::filesystem::path& file) {
  std::error_code error;
  const std::string name = file.string() + ".damaged";
  std::filesystem::path aside = name;
  for (int i = 2; std::filesystem::exists(std::filesystem::symlink_status(aside, error)); ++i) {
    aside = name + "-" + std::to_string(i);
  }
  std::filesystem::rename(file, aside, error);
  if (error == std::errc::no_such_file_or_directory) {
    return {};
  }
  if (error) {
    throw Error(ErrorKind::kFailure,
                file.string() + ": is damaged and cannot be set aside (" + error.message() + ")");
  }
  return aside;
}

/// Whether all bytes of a file can be had: only then a fault lies in the file.
bool can_be_read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> bytes(std::size_t{1} << 16U);
  while (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
  }
  return stream.is_open() && stream.eof() && !stream.bad();
}

}  // namespace

MapTiles::MapTiles(std::filesystem::path folder, const MapTilesConfig& config)
    : folder_(std::move(folder)), config_(checked(config)), lock_(made(folder_)) {
  remove_unfinished_files(folder_,
                          [](const std::string& name) { return tile_named(name).has_value(); });
  for (const Tile& tile : tiles_in(folder_)) {
    tiles_[tile].away = true;
  }
}

std::size_t MapTiles::away_count() const noexcept {
  return static_cast<std::size_t>(std::count_if(
      tiles_.begin(), tiles_.end(), [](const auto& tile) { return tile.second.away; }));
}

void MapTiles::follow(const Eigen::Vector3d& position_m, SparseMap& map) {
  if (!position_m.allFinite()) {
    return;
  }
  if (!checked_) {
    check_lattice(map);
  }
  for (auto& [tile, state] : tiles_) {
    if (state.away && distance_m(position_m, place_of(tile), map.lattice()) <= config_.reach_m) {
      bring_in(tile, map);
    }
  }
  if (map.held_bytes() > config_.budget_bytes) {
    put_out_far(position_m, map);
  }
}

/// Of a folder of another map nothing may be mixed with this one, nor set aside.
void MapTiles::check_lattice(const SparseMap& map) {
  for (const auto& [tile, state] : tiles_) {
    const auto header = state.away ? readable_header(folder_, tile) : std::nullopt;
    if (header && header->lattice != map.lattice()) {
      throw input_error(file_of(tile), "has other cells than the map");
    }
  }
  checked_ = true;
}

std::uint64_t MapTiles::whole_bytes(const SparseMap& map) const {
  std::uint64_t bytes = map.held_bytes();
  for (const auto& [tile, state] : tiles_) {
    if (const auto header = state.away ? readable_header(folder_, tile) : std::nullopt) {
      bytes += SparseMap::held_bytes(header->bricks, header->mixed);
    }
  }
  return bytes;
}

void MapTiles::bring_in_all(SparseMap& map) {
  for (auto& [tile, state] : tiles_) {
    if (state.away) {
      bring_in(tile, map);
    }
  }
}

void MapTiles::flush(SparseMap& map) {
  if (!checked_) {
    check_lattice(map);
  }
  for (const auto& [tile, resident] : residents(map)) {
    if (tiles_[tile].away) {  // a scan reached it before the drone did
      bring_in(tile, map);
    }
  }
  const Residents all = residents(map);
  for (const auto& [tile, resident] : all) {
    const TileState& state = tiles_[tile];
    if (resident.changed_at > state.saved_at || resident.bricks.size() != state.saved_bricks) {
      write(tile, resident, map);
    }
  }
  // Of a tile of which nothing is known any more, the file must not come back.
  std::erase_if(tiles_, [&](const auto& entry) {
    const bool is_forgotten = !entry.second.away && !all.contains(entry.first);
    if (is_forgotten) {
      std::error_code ignored;
      std::filesystem::remove(file_of(entry.first), ignored);
    }
    return is_forgotten;
  });
}

std::filesystem::path MapTiles::file_of(const Tile& tile) const {
  return folder_ / tile_file_name(tile);
}

MapTiles::Residents MapTiles::residents(const SparseMap& map) const {
  Residents residents;
  for (const Eigen::Vector3i& brick : map.bricks()) {
    Resident& resident = residents[tile_of(brick)];
    resident.bricks.push_back(brick);
    resident.changed_at = std::max(resident.changed_at, map.changed_at(brick));
  }
  return residents;
}

std::optional<SparseMap> MapTiles::read_or_set_aside(const Tile& tile) {
  try {
    return read_tile(folder_, tile).map;
  } catch (const Error& error) {
    std::error_code ignored;
    if (std::filesystem::exists(file_of(tile), ignored) && !can_be_read(file_of(tile))) {
      throw;
    }
    damaged_.push_back({.problem = error.what(), .set_aside = set_aside(file_of(tile))});
    tiles_[tile] = {};
    return std::nullopt;
  }
}

void MapTiles::bring_in(const Tile& tile, SparseMap& map) {
  const std::optional<SparseMap> saved = read_or_set_aside(tile);
  if (!saved) {
    return;
  }
  if (saved->lattice() != map.lattice()) {
    throw input_error(file_of(tile), "has other cells than the map");
  }
  bool was_empty = true;
  for_each_brick(tile, [&](const Eigen::Vector3i& brick) {
    was_empty = was_empty && !map.holds_brick(brick);
  });
  BrickCells cells;  // NOLINT(*-member-init): filled by the maps
  BrickCells known;  // NOLINT(*-member-init)
  for (const Eigen::Vector3i& brick : saved->bricks()) {
    saved->copy_brick(brick, cells);
    map.copy_brick(brick, known);
    for (std::size_t i = 0; i < kBrickCells; ++i) {
      if (known.cells[i] != kUnknown) {
        const int before = cells.cells[i] == kUnknown ? 0 : cells.cells[i];
        cells.cells[i] = updated(known.cells[i], before, config_.limit_units);
      }
    }
    map.set_brick(brick, cells);
  }
  // What a scan said before the tile was here is not in the file yet.
  tiles_[tile] = {
      .away = false, .saved_at = was_empty ? map.tick() : 0, .saved_bricks = saved->brick_count()};
}

void MapTiles::write(const Tile& tile, const Resident& resident, const SparseMap& map) {
  SparseMap part(map.lattice());
  BrickCells cells;  // NOLINT(*-member-init): filled by the map
  for (const Eigen::Vector3i& brick : resident.bricks) {
    map.copy_brick(brick, cells);
    part.set_brick(brick, cells);
  }
  // The folder was cleared of leftovers when it was opened; nobody else writes to it.
  write_skymap(
      file_of(tile), part, {.limit_units = config_.limit_units}, Progress(), Leftovers::kLeave);
  tiles_[tile] = {.away = false, .saved_at = map.tick(), .saved_bricks = resident.bricks.size()};
}

/// Puts out the farthest tiles until the map takes three quarters of its budget, so that this is
/// not needed again at once.
void MapTiles::put_out_far(const Eigen::Vector3d& position_m, SparseMap& map) {
  std::vector<std::pair<double, Tile>> far;
  const Residents all = residents(map);
  for (const auto& [tile, resident] : all) {
    const double away_m = distance_m(position_m, place_of(tile), map.lattice());
    if (away_m > config_.reach_m) {
      far.emplace_back(away_m, tile);
    }
  }
  std::sort(far.rbegin(), far.rend());
  for (const auto& [away_m, tile] : far) {
    if (map.held_bytes() <= config_.budget_bytes / 4 * 3) {
      return;
    }
    if (tiles_[tile].away) {
      bring_in(tile, map);
      write(tile, residents(map).at(tile), map);
    } else if (all.at(tile).changed_at > tiles_[tile].saved_at ||
               all.at(tile).bricks.size() != tiles_[tile].saved_bricks) {
      write(tile, all.at(tile), map);
    }
    for_each_brick(tile, [&](const Eigen::Vector3i& brick) { map.erase_brick(brick); });
    tiles_[tile].away = true;
  }
}

}  // namespace skyhalo
