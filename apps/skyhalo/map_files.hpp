#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "skyhalo/io/map_slice.hpp"
#include "skyhalo/io/progress.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo::app {

/// What map files there are; the first three can be read back. Tiles are a folder of them, which
/// can only be read.
enum class MapFormat { kSkymap, kOctomapFull, kOctomapBinary, kPly, kPcd, kSlice, kTiles };

/// The format by a file's extension, in small or capital letters; none for another.
std::optional<MapFormat> format_of(const std::filesystem::path& file);

std::string name_of(MapFormat format);

/// A map as it was read.
struct LoadedMap {
  SparseMap map;
  MapFormat format;
  std::optional<int> limit_units;  ///< that the file names; OctoMap files name none
};

/// Reads a map, from a file or from the tiles in a folder. Throws `Error` (input) for a format that
/// cannot be read back, and as the readers do.
LoadedMap read_map(const std::filesystem::path& file,
                   std::uint64_t max_bytes,
                   const Progress& progress);

/// Bytes of a map's file, or of all tiles in a folder.
std::uint64_t file_bytes(const std::filesystem::path& map);

/// How maps are written.
struct MapOutput {
  std::filesystem::path file;
  MapFormat format = MapFormat::kSkymap;
  std::optional<HeightRange> slice;  ///< of formats that are one
  OccupancyRule rule;                ///< of formats that have occupied cells only, or no log odds
};

/// Reads and checks what the user wants: a format by the file's extension, and `Z0:Z1` for a slice
/// and for nothing else. Throws `UsageError`.
MapOutput parse_output(const std::string& file, const std::string& slice);

/// Writes a map, whole or not at all. Throws `Error` as the writers do.
void write_map(const MapOutput& output,
               const SparseMap& map,
               int limit_units,
               const Progress& progress);

}  // namespace skyhalo::app
