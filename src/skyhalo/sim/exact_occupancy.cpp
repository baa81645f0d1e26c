#include "skyhalo/sim/exact_occupancy.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "skyhalo/base/for_each_index.hpp"

namespace skyhalo {
namespace {

/// Whether the projections of the triangle and of the cube about the origin with this half edge on
/// an axis are apart.
bool apart_along(const Eigen::Vector3d& axis,
                 const Eigen::Matrix3d& corners,
                 double half) noexcept {
  const Eigen::RowVector3d at = axis.transpose() * corners;
  const double reach = half * axis.cwiseAbs().sum();
  return at.minCoeff() > reach || at.maxCoeff() < -reach;
}

/// Whether the triangle keeps away from the half-open cube along one of the cube's own axes.
bool beside(const Eigen::Matrix3d& corners_m,
            const VoxelGrid& grid,
            const Eigen::Vector3i& cell) noexcept {
  const Eigen::Vector3d lower_m = grid.min_m + grid.voxel_m * cell.cast<double>();
  const Eigen::Vector3d upper_m =
      grid.min_m + grid.voxel_m * (cell.array() + 1).matrix().cast<double>();
  return (corners_m.rowwise().maxCoeff().array() < lower_m.array()).any() ||
         (corners_m.rowwise().minCoeff().array() >= upper_m.array()).any();
}

Eigen::Matrix3d corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  Eigen::Matrix3d corners_m;
  corners_m << mesh.vertices_m[a].cast<double>(), mesh.vertices_m[b].cast<double>(),
      mesh.vertices_m[c].cast<double>();
  return corners_m;
}

void enter(const Eigen::Matrix3d& corners_m, const VoxelGrid& grid, std::uint8_t* cells) noexcept {
  const Eigen::Vector3d low_m = corners_m.rowwise().minCoeff();
  const Eigen::Vector3d high_m = corners_m.rowwise().maxCoeff();
  if ((high_m.array() < grid.min_m.array()).any() ||
      (low_m.array() >= grid.max_m().array()).any()) {
    return;
  }
  const auto index = [&](const Eigen::Vector3d& p_m) {
    // One more on both sides costs little; what rounding puts there is judged like the rest.
    return ((p_m - grid.min_m) / grid.voxel_m).array().floor();
  };
  const Eigen::Array3i first = (index(low_m).max(1.0) - 1.0).cast<int>();
  const Eigen::Array3i last =
      (index(high_m) + 1.0).min(grid.size.cast<double>().array() - 1.0).cast<int>();
  Eigen::Vector3i cell;
  for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x()) {
    for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y()) {
      for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z()) {
        if (meets_cell(corners_m, grid, cell)) {
          std::atomic_ref<std::uint8_t>(cells[grid.offset_of(cell)])
              .store(1, std::memory_order_relaxed);
        }
      }
    }
  }
}

}  // namespace

bool meets_cell(const Eigen::Matrix3d& corners_m,
                const VoxelGrid& grid,
                const Eigen::Vector3i& cell) noexcept {
  if (beside(corners_m, grid, cell)) {
    return false;
  }
  const Eigen::Matrix3d corners = corners_m.colwise() - grid.center_m(cell);
  const double half_m = 0.5 * grid.voxel_m;
  const Eigen::Matrix3d edges = (Eigen::Matrix3d() << corners.col(1) - corners.col(0),
                                 corners.col(2) - corners.col(1),
                                 corners.col(0) - corners.col(2))
                                    .finished();
  if (apart_along(edges.col(0).cross(edges.col(1)), corners, half_m)) {
    return false;
  }
  for (int edge = 0; edge < 3; ++edge) {
    for (int axis = 0; axis < 3; ++axis) {
      if (apart_along(Eigen::Vector3d::Unit(axis).cross(edges.col(edge)), corners, half_m)) {
        return false;
      }
    }
  }
  return true;
}

std::vector<std::uint8_t> exact_occupancy(const TriangleMesh& mesh, const VoxelGrid& grid) {
  constexpr std::size_t kBatch = 1024;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(grid.cell_count()), 0);
  const std::size_t batches = (mesh.triangles.size() + kBatch - 1) / kBatch;
  for_each_index(batches, [&](std::size_t batch) {
    const std::size_t end = std::min((batch + 1) * kBatch, mesh.triangles.size());
    for (std::size_t i = batch * kBatch; i < end; ++i) {
      enter(corners_of(mesh, i), grid, cells.data());
    }
  });
  return cells;
}

}  // namespace skyhalo
