#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "skyhalo/io/skymap_file.hpp"

namespace skyhalo {

/// A cube of 8 x 8 x 8 bricks (64 x 64 x 64 cells) of a sparse map: its number along x, y and z.
using Tile = std::tuple<int, int, int>;

/// Bricks along each side of a tile.
inline constexpr int kTileBricks = 8;

/// The tile that a brick is in.
[[nodiscard]] Tile tile_of(const Eigen::Vector3i& brick) noexcept;

/// The name of a tile's file in its folder, `tile_X_Y_Z.skymap`.
[[nodiscard]] std::string tile_file_name(const Tile& tile);

/// The tile whose file has this name; none for other files.
[[nodiscard]] std::optional<Tile> tile_named(const std::string& name);

/// The tiles that a folder has files of, sorted. Throws `Error` (input) when it cannot be read.
[[nodiscard]] std::vector<Tile> tiles_in(const std::filesystem::path& folder);

/// Reads one tile. Throws `Error` (input) naming the file, as `read_skymap` does and when it holds
/// cells of another tile.
[[nodiscard]] Skymap read_tile(const std::filesystem::path& folder, const Tile& tile);

/// Reads the head of a tile's file only. Throws `Error` (input) as `read_skymap_header` does and
/// when the file claims more bricks than a tile can have.
[[nodiscard]] SkymapHeader read_tile_header(const std::filesystem::path& folder, const Tile& tile);

/// Reads a folder of tiles as one map, with the largest of their limits. Takes at most `max_bytes`
/// of memory, up to a fixed few MiB. While a run writes there, each tile is as it was last written.
/// Throws `Error` (input) naming the file or the folder: no tiles, one is damaged or has other
/// cells than the others, too large.
[[nodiscard]] Skymap read_tiles(const std::filesystem::path& folder,
                                std::uint64_t max_bytes = kMapMemoryBytes,
                                const Progress& progress = {});

}  // namespace skyhalo
