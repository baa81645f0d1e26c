#pragma once

#include <cstdint>
#include <filesystem>

#include "skyhalo/io/map_limits.hpp"
#include "skyhalo/io/octree_check.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// Writes a map as an OctoMap file (readable by octovis and OctoMap's tools): `.ot` with the log
/// odds of all known cells, `.bt` with occupied for those of log odds 0 or more, else free. An
/// octree's cells lie on multiples of its resolution: a map that does not lie there is shifted, as
/// a whole, by at most half a cell. The file is whole under its name or not there (see
/// `UnfinishedFile`). Takes about 25 times the map's memory. Throws `Error` (failure) when the map
/// leaves the octree's range (+-32768 cells) or the file cannot be written.
void write_octomap(const std::filesystem::path& file, const SparseMap& map, OctreeForm form);

/// Reads an OctoMap file of the type OcTree. Cell (0, 0, 0) begins at the origin. Leaves of a `.bt`
/// file have the log odds that OctoMap gives them: 3.511 and -2. Log odds are rounded to 0.001 and
/// kept within +-32.767. Takes at most `max_bytes` of memory, whatever the file says. Throws
/// `Error` (input) naming the file and what is wrong with it.
[[nodiscard]] SparseMap read_octomap(const std::filesystem::path& file,
                                     OctreeForm form,
                                     std::uint64_t max_bytes = kMapMemoryBytes);

}  // namespace skyhalo
