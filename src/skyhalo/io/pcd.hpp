#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/io/map_points.hpp"

namespace skyhalo {

/// Writes points as binary PCD (version 0.7, of the Point Cloud Library) with `x y z` (m) and
/// `intensity`, the probability. Throws `Error` (failure) when it cannot be written.
void write_pcd(const std::filesystem::path& file, const std::vector<OccupiedPoint>& points);

}  // namespace skyhalo
