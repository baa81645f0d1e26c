#include "skyhalo/map/local_map.hpp"

#include <cmath>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr int kMostCells = 4096;

CellBox box_round(const Eigen::Vector3i& center, const Eigen::Vector3i& size) noexcept {
  const Eigen::Vector3i min = center - size / 2;
  return {min, min + size};
}

const Eigen::Vector3i& checked(const Eigen::Vector3i& size_cells, double voxel_m) {
  if (!(voxel_m > 0.0) || !std::isfinite(voxel_m)) {
    throw Error(ErrorKind::kInput, "local map: expected cells of more than 0 m");
  }
  if ((size_cells.array() < 1).any() || (size_cells.array() > kMostCells).any()) {
    throw Error(ErrorKind::kInput, "local map: expected sides of 1 to 4096 cells");
  }
  return size_cells;
}

/// Whole bricks along z, so that no row of one falls on the ring's seam.
Eigen::Vector3i room_of(const Eigen::Vector3i& size_cells) noexcept {
  return {
      size_cells.x(), size_cells.y(), (size_cells.z() + kBrickEdge - 1) / kBrickEdge * kBrickEdge};
}

}  // namespace

Eigen::Vector3i local_map_cells(const Eigen::Vector3d& size_m, double voxel_m) {
  // Sides that are whole but for rounding are whole.
  const Eigen::Array3d cells = (size_m.array() / voxel_m - 1e-6).ceil();
  if (!(voxel_m > 0.0) || !(cells >= 1.0).all() || !(cells <= kMostCells).all()) {
    throw Error(ErrorKind::kInput, "local map: expected sides above 0 m and of at most 4096 cells");
  }
  return cells.matrix().cast<int>();
}

LocalMap::LocalMap(const Eigen::Vector3i& size_cells, double voxel_m)
    : CellWindow({Eigen::Vector3d::Zero(), voxel_m},
                 box_round(Eigen::Vector3i::Zero(), checked(size_cells, voxel_m)),
                 room_of(size_cells)) {}

void LocalMap::follow(const Eigen::Vector3d& position_m) noexcept {
  if (position_m.allFinite()) {
    move_to(box_round(lattice().cell_of(position_m), bounds().size()));
  }
}

}  // namespace skyhalo
