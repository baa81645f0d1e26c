#pragma once

#include <filesystem>

#include "skyhalo/dataset/laser_source.hpp"

namespace skyhalo {

/// Reads a KITTI Velodyne scan: records of four little-endian floats x, y, z (m) and reflectance.
/// Records with a coordinate that is not finite are left out. Throws `Error` (input) naming the
/// file when it is missing, empty or not a whole number of records.
[[nodiscard]] LaserScan read_velodyne(const std::filesystem::path& file);

}  // namespace skyhalo
