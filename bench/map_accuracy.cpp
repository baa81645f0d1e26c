#include "map_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "skyhalo/geometry/lattice_walk.hpp"

namespace skyhalo::bench {
namespace {

constexpr double kMostCells = 3e6;

bool is_seen_from(const testing::MapScene& scene,
                  const Eigen::Vector3d& eye_m,
                  const Eigen::Vector3d& point_m) {
  const double distance_m = (point_m - eye_m).norm();
  return distance_m > 0.0 && distance_m <= kRangeM &&
         scene.range_m({eye_m, (point_m - eye_m) / distance_m}) >= distance_m;
}

bool is_observable(const Flight& flight, const Eigen::Vector3d& point_m) {
  return std::any_of(flight.scans.begin(), flight.scans.end(), [&](const FlownScan& scan) {
    return is_seen_from(flight.scene, scan.T_map_body.translation(), point_m);
  });
}

std::vector<Eigen::Vector3d> surface_cells(const Flight& flight, const VoxelLattice& lattice) {
  std::set<std::tuple<int, int, int>> cells;
  for (const FlownScan& scan : flight.scans) {
    for (const Eigen::Vector3d& end_m : scan.ends_m) {
      const Eigen::Vector3i cell = lattice.cell_of(end_m);
      cells.emplace(cell.x(), cell.y(), cell.z());
    }
  }
  std::vector<Eigen::Vector3d> middles_m;
  middles_m.reserve(cells.size());
  for (const auto& [x, y, z] : cells) {
    middles_m.push_back(lattice.center_m({x, y, z}));
  }
  return middles_m;
}

double share_of(const Contender& map, const std::vector<Eigen::Vector3d>& cells, Occupancy what) {
  const auto count = std::count_if(
      cells.begin(), cells.end(), [&](const Eigen::Vector3d& at) { return map.at(at) == what; });
  return static_cast<double>(count) / static_cast<double>(cells.size());
}

}  // namespace

MapTruth truth_of(const Flight& flight, double voxel_m) {
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), voxel_m};
  MapTruth truth{{}, surface_cells(flight, lattice)};
  const Eigen::Vector3d inward_m = Eigen::Vector3d::Constant(0.5 * voxel_m);
  const CellBox cells =
      cells_touching(lattice, flight.bounds_m.min() + inward_m, flight.bounds_m.max() - inward_m);
  // A step without a factor in common with the sides, so that no layer is left out.
  auto every =
      static_cast<std::int64_t>(std::ceil(static_cast<double>(cells.cell_count()) / kMostCells));
  while (std::gcd(every, cells.size().cast<std::int64_t>().prod()) > 1) {
    ++every;
  }
  std::int64_t number = 0;
  for_each_cell(cells, [&](const Eigen::Vector3i& cell) {
    const Eigen::Vector3d corner_m = lattice.corner_m(cell);
    const Eigen::Vector3d middle_m = lattice.center_m(cell);
    if (number++ % every == 0 &&
        !flight.scene.has_surface({corner_m, corner_m.array() + voxel_m}) &&
        is_observable(flight, middle_m)) {
      truth.free_m.push_back(middle_m);
    }
    return true;
  });
  return truth;
}

MapScore score(const Contender& map, const MapTruth& truth) {
  return {share_of(map, truth.free_m, Occupancy::kFree),
          share_of(map, truth.surface_m, Occupancy::kOccupied),
          share_of(map, truth.free_m, Occupancy::kOccupied)};
}

}  // namespace skyhalo::bench
