#pragma once

#include "skyhalo/geometry/voxel_lattice.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "skyhalo/map/scan_integrator.hpp"

namespace skyhalo {

/// How much a scan has to say.
struct ScanSize {
  int rows = 0;            ///< of directions, half as many as columns
  int things = 0;          ///< directions with a range
  int free = 0;            ///< directions that are free without one
  double longest_m = 0.0;  ///< the farthest thing or free space
  double mean_m = 0.0;     ///< over those directions
};

[[nodiscard]] ScanSize size_of(const RangeScan& scan) noexcept;

/// The method that likely takes less time for a scan whose reach touches these cells of a map. The
/// same answer on every machine.
[[nodiscard]] IntegrationMethod cheaper_method(const ScanSize& scan,
                                               const CellBox& region,
                                               double voxel_m) noexcept;

}  // namespace skyhalo
