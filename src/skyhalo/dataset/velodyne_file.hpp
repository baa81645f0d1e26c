#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/dataset/laser_source.hpp"

namespace skyhalo {

/// Reads a KITTI Velodyne scan: records of four little-endian floats x, y, z (m) and reflectance.
/// Records with a coordinate that is not finite are left out. Throws `Error` (input) naming the
/// file when it is missing, empty or not a whole number of records.
[[nodiscard]] LaserScan read_velodyne(const std::filesystem::path& file);

/// A scan and how strongly each point shone back.
struct LaserReturns {
  LaserScan points_m;               ///< scanner's frame
  std::vector<float> reflectances;  ///< 0...1, one per point; or empty, which is 0 for all
};

/// Writes a scan in the same form; one without points is an empty file. Throws `Error` (input)
/// naming the file when a coordinate is not finite or there is another number of reflectances, and
/// `Error` (failure) when it cannot be written.
void write_velodyne(const std::filesystem::path& file, const LaserReturns& scan);

}  // namespace skyhalo
