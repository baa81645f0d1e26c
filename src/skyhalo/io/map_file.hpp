#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/io/ply.hpp"
#include "skyhalo/map/dense_map.hpp"

namespace skyhalo {

/// Centres of the cells whose probability is above `occupied_probability`, coloured by height.
[[nodiscard]] std::vector<ColouredPoint> occupied_points(const DenseMap& map,
                                                         double occupied_probability);

/// Centres of the cells at these positions of the grid's memory, coloured by height.
[[nodiscard]] std::vector<ColouredPoint> cell_points(const VoxelGrid& grid,
                                                     const std::vector<std::int64_t>& offsets);

/// Writes all observed cells with their log odds as an OctoMap `.ot` file (readable by octovis and
/// OctoMap's tools). An octree's cells lie on multiples of its resolution: a map that does not lie
/// there is shifted, as a whole, by at most half a cell. Throws `Error` (failure) when the map
/// leaves the octree's range
/// (+-32768 cells) or the file cannot be written.
void write_octree(const std::filesystem::path& file, const DenseMap& map);

}  // namespace skyhalo
