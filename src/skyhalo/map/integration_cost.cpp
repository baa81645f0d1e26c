#include "skyhalo/map/integration_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace skyhalo {
namespace {

// Times of the parts of both ways (ns), as measured by `bench_map`; only their ratios matter.
constexpr double kPerStepNs = 12.0;  // of a ray, from cell to cell
constexpr double kPerRayNs = 60.0;
constexpr double kPerDirectionNs = 12.0;  // of the scan, before a sweep
constexpr double kPerSeenCellNs = 2.5;    // of the space that is seen
constexpr double kPerCellNs = 0.005;      // of the region, which is gone through in large pieces

/// A ray in a random direction crosses this many cells per edge's length.
constexpr double kStepsPerCell = 1.5;

/// Directions are counted side by side, which a compiler makes vectors of.
constexpr std::size_t kLanes = 4;

struct SizeLanes {
  std::array<float, kLanes> sum_m{};
  std::array<float, kLanes> longest_m{};
  std::array<std::int32_t, kLanes> things{};
  std::array<std::int32_t, kLanes> free{};

  void add(std::size_t lane, float z_m, float free_to_m) noexcept {
    const float range_m = z_m > 0.0F ? z_m : free_to_m;
    sum_m[lane] += range_m;
    longest_m[lane] = longest_m[lane] > range_m ? longest_m[lane] : range_m;
    things[lane] += z_m > 0.0F ? 1 : 0;
    free[lane] += free_to_m > 0.0F ? 1 : 0;
  }
};

}  // namespace

ScanSize size_of(const RangeScan& scan) noexcept {
  ScanSize size{.rows = scan.rows()};
  SizeLanes lanes;
  const std::size_t count = scan.z_m().size();
  const std::size_t whole = count - count % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes.add(lane, scan.z_m()[i + lane], scan.free_to_m()[i + lane]);
    }
  }
  for (std::size_t i = whole; i < count; ++i) {
    lanes.add(i - whole, scan.z_m()[i], scan.free_to_m()[i]);
  }
  double sum_m = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    sum_m += static_cast<double>(lanes.sum_m[lane]);
    size.longest_m = std::max(size.longest_m, static_cast<double>(lanes.longest_m[lane]));
    size.things += lanes.things[lane];
    size.free += lanes.free[lane];
  }
  const int directions = size.things + size.free;
  size.mean_m = directions > 0 ? sum_m / directions : 0.0;
  return size;
}

IntegrationMethod cheaper_method(const ScanSize& scan,
                                 const CellBox& region,
                                 double voxel_m) noexcept {
  const Eigen::Vector3d sides_m = voxel_m * region.size().cast<double>();
  const double steps = kStepsPerCell * std::min(scan.mean_m, 0.5 * sides_m.norm()) / voxel_m;
  const int directions = scan.things + scan.free;
  const double rays_ns = directions * (kPerRayNs + kPerStepNs * steps);
  // The space seen: that share of a ball with the mean range, as far as it is in the region.
  const double share = directions / (2.0 * scan.rows * scan.rows);
  const double seen_cells =
      share * 4.0 / 3.0 * std::numbers::pi * std::pow(scan.mean_m / voxel_m, 3);
  const double region_cells = region.size().cast<double>().prod();
  const double sweep_ns = 2.0 * scan.rows * scan.rows * kPerDirectionNs +
                          std::min(seen_cells, region_cells) * kPerSeenCellNs +
                          region_cells * kPerCellNs;
  return rays_ns < sweep_ns ? IntegrationMethod::kRays : IntegrationMethod::kSweep;
}

}  // namespace skyhalo
