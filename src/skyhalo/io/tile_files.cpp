#include "skyhalo/io/tile_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "tile";
constexpr std::string_view kSuffix = ".skymap";

constexpr std::uint64_t kBricksInTile = std::uint64_t{kTileBricks} * kTileBricks * kTileBricks;

/// What the heads of all files say together.
SkymapHeader sum_of(const fs::path& folder,
                    const std::vector<Tile>& tiles,
                    std::uint64_t max_bytes) {
  SkymapHeader sum = read_tile_header(folder, tiles.front());
  sum.bricks = 0;
  sum.mixed = 0;
  for (const Tile& tile : tiles) {
    const SkymapHeader header = read_tile_header(folder, tile);
    if (header.lattice != sum.lattice) {
      throw input_error(folder / tile_file_name(tile),
                        "has other cells than " + tile_file_name(tiles.front()));
    }
    sum.bricks += header.bricks;
    sum.mixed += header.mixed;
    sum.info.limit_units = std::max(sum.info.limit_units, header.info.limit_units);
  }
  if (!fits_in_memory(sum.bricks, sum.mixed, max_bytes)) {
    throw input_error(folder, too_large_text(max_bytes));
  }
  return sum;
}

/// Takes over all bricks of a map of the same lattice.
void copy_bricks(const SparseMap& from, SparseMap& to) {
  BrickCells cells;  // NOLINT(*-member-init): filled by the map
  for (const Eigen::Vector3i& brick : from.bricks()) {
    if (const std::optional<LogOdds> value = from.uniform(brick)) {
      to.set_uniform(brick, *value);
    } else {
      from.copy_brick(brick, cells);
      to.set_brick(brick, cells);
    }
  }
}

}  // namespace

Tile tile_of(const Eigen::Vector3i& brick) noexcept {
  static_assert(kTileBricks == 1 << 3);
  return {brick.x() >> 3, brick.y() >> 3, brick.z() >> 3};
}

std::string tile_file_name(const Tile& tile) {
  std::string name(kPrefix);
  for (const int number : {std::get<0>(tile), std::get<1>(tile), std::get<2>(tile)}) {
    name += "_" + std::to_string(number);
  }
  return name.append(kSuffix);
}

std::optional<Tile> tile_named(const std::string& name) {
  constexpr int kMostTiles = VoxelLattice::kReach / (kTileBricks * kBrickEdge);
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) {
    return std::nullopt;
  }
  std::array<int, 3> place{};
  const char* at = name.data() + kPrefix.size();
  const char* const end = name.data() + name.size() - kSuffix.size();
  for (int& number : place) {
    if (at >= end || *at != '_') {
      return std::nullopt;
    }
    const auto [next, status] = std::from_chars(at + 1, end, number);
    if (status != std::errc() || number < -kMostTiles || number >= kMostTiles) {
      return std::nullopt;
    }
    at = next;
  }
  const Tile tile(place[0], place[1], place[2]);
  return tile_file_name(tile) == name ? std::optional(tile) : std::nullopt;
}

std::vector<Tile> tiles_in(const fs::path& folder) {
  std::vector<Tile> tiles;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (const std::optional<Tile> tile = tile_named(entry->path().filename().string())) {
      tiles.push_back(*tile);
    }
  }
  if (error) {
    throw input_error(folder, "cannot be read (" + error.message() + ")");
  }
  std::sort(tiles.begin(), tiles.end());
  return tiles;
}

Skymap read_tile(const fs::path& folder, const Tile& tile) {
  const fs::path file = folder / tile_file_name(tile);
  (void)read_tile_header(folder, tile);
  Skymap read = read_skymap(file);
  for (const Eigen::Vector3i& brick : read.map.bricks()) {
    if (tile_of(brick) != tile) {
      throw input_error(file, "holds cells of another tile");
    }
  }
  return read;
}

SkymapHeader read_tile_header(const fs::path& folder, const Tile& tile) {
  const fs::path file = folder / tile_file_name(tile);
  SkymapHeader header = read_skymap_header(file);
  if (header.bricks > kBricksInTile) {
    throw input_error(file, "holds more bricks than a tile has");
  }
  return header;
}

Skymap read_tiles(const fs::path& folder, std::uint64_t max_bytes, const Progress& progress) {
  const std::vector<Tile> tiles = tiles_in(folder);
  if (tiles.empty()) {
    throw input_error(folder, "is a folder without tiles of a map (tile_X_Y_Z.skymap)");
  }
  const SkymapHeader sum = sum_of(folder, tiles, max_bytes);
  Skymap whole{.map = SparseMap(sum.lattice), .info = sum.info};
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Skymap part = read_tile(folder, tiles[i]);
    if (part.map.lattice() != sum.lattice) {
      throw input_error(folder / tile_file_name(tiles[i]), "has changed while it was read");
    }
    copy_bricks(part.map, whole.map);
    if (progress) {
      progress(static_cast<double>(i + 1) / static_cast<double>(tiles.size()));
    }
  }
  return whole;
}

}  // namespace skyhalo
