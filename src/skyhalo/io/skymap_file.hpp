#pragma once

#include <cstdint>
#include <filesystem>

#include "skyhalo/io/map_limits.hpp"
#include "skyhalo/io/progress.hpp"
#include "skyhalo/io/unfinished_file.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// What a `.skymap` file says besides the cells.
struct SkymapInfo {
  /// Log odds were kept within +-this when the map was made, in units of 0.001; 1 to 32767.
  int limit_units = 5000;

  friend bool operator==(const SkymapInfo&, const SkymapInfo&) = default;
};

/// What the head of a `.skymap` file says.
struct SkymapHeader {
  VoxelLattice lattice;
  SkymapInfo info;
  std::uint64_t bricks = 0;
  std::uint64_t mixed = 0;  ///< bricks with cells of their own, not one value for all
};

/// A map and what its file says of it.
struct Skymap {
  SparseMap map;
  SkymapInfo info;
};

/// Writes a map as `.skymap`: all of it, losslessly, packed. Equal maps give equal bytes. The file
/// is whole under its name or not there, even if the program is killed (see `UnfinishedFile`).
/// Throws `Error`: failure when it cannot be written, input when the limit or the lattice is none
/// that could be read back.
void write_skymap(const std::filesystem::path& file,
                  const SparseMap& map,
                  const SkymapInfo& info,
                  const Progress& progress = {},
                  Leftovers leftovers = Leftovers::kRemove);

/// Reads a `.skymap` file. Takes at most `max_bytes` of memory, whatever the file says, up to a
/// fixed few MiB. Throws `Error` (input) naming the file and what is wrong with it: no such file,
/// another kind of file, another version, damaged, cut off, too large.
[[nodiscard]] Skymap read_skymap(const std::filesystem::path& file,
                                 std::uint64_t max_bytes = kMapMemoryBytes,
                                 const Progress& progress = {});

/// Reads the head of a `.skymap` file only. Throws `Error` (input) as `read_skymap` does for the
/// head; of damage farther on it does not know.
[[nodiscard]] SkymapHeader read_skymap_header(const std::filesystem::path& file,
                                              std::uint64_t max_bytes = kMapMemoryBytes);

}  // namespace skyhalo
