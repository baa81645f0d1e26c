#include "skyhalo/io/map_limits.hpp"

#include "skyhalo/base/number_text.hpp"

namespace skyhalo {

std::string lattice_fault(const VoxelLattice& lattice) {
  constexpr double kSmallestVoxelM = 1e-4;
  constexpr double kLargestVoxelM = 1e4;
  constexpr double kFarthestOriginM = 1e9;
  // Not less than, so that NaN is refused too.
  if (!(lattice.voxel_m >= kSmallestVoxelM && lattice.voxel_m <= kLargestVoxelM)) {
    return "has cells of " + number_text("%g", lattice.voxel_m) + " m, expected 0.0001 to 10000 m";
  }
  if (!(lattice.origin_m.array().abs() <= kFarthestOriginM).all()) {
    return "has its origin at (" + number_text("%g", lattice.origin_m.x()) + ", " +
           number_text("%g", lattice.origin_m.y()) + ", " +
           number_text("%g", lattice.origin_m.z()) + ") m, expected within 1e9 m";
  }
  return "";
}

std::string too_large_text(std::uint64_t max_bytes) {
  return "would take more than " + std::to_string(max_bytes >> 20U) +
         " MiB of memory, the limit for reading a map";
}

}  // namespace skyhalo
