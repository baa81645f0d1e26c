#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "skyhalo/geometry/voxel_grid.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo::reference {

using NaivePolygon = std::vector<Eigen::Vector3d>;  ///< corners (m), in order

/// An axis-aligned cube between two corners (m).
struct NaiveCube {
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d max_m = Eigen::Vector3d::Ones();
};

/// Whether a triangle and a cell have a point in common; `kBorder` is too close to tell.
enum class NaiveMeeting { kApart, kBorder, kMeets };

/// The part of a polygon where `sign * (coordinate - limit) <= 0` (Sutherland and Hodgman 1974).
inline NaivePolygon naive_clip(const NaivePolygon& polygon, int axis, double sign, double limit_m) {
  NaivePolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& here = polygon[i];
    const Eigen::Vector3d& next = polygon[(i + 1) % polygon.size()];
    const double beyond_here = sign * (here[axis] - limit_m);
    const double beyond_next = sign * (next[axis] - limit_m);
    if (beyond_here <= 0.0) {
      kept.push_back(here);
    }
    if ((beyond_here < 0.0 && beyond_next > 0.0) || (beyond_here > 0.0 && beyond_next < 0.0)) {
      Eigen::Vector3d cut = here + beyond_here / (beyond_here - beyond_next) * (next - here);
      cut[axis] = limit_m;
      kept.push_back(cut);
    }
  }
  return kept;
}

/// The part of a polygon inside a cube, faces included.
inline NaivePolygon naive_clip(const NaivePolygon& polygon, const NaiveCube& cube) {
  NaivePolygon part = polygon;
  for (int axis = 0; axis < 3; ++axis) {
    part = naive_clip(part, axis, -1.0, cube.min_m[axis]);
    part = naive_clip(part, axis, 1.0, cube.max_m[axis]);
  }
  return part;
}

/// Whether a polygon has a point in a cube whose lower faces belong to it and whose upper ones do
/// not. What is left of the polygon after clipping is convex, so the mean of its corners is below
/// an upper face as soon as one of them is.
inline bool naive_meets_half_open(const NaivePolygon& polygon, const NaiveCube& cube) {
  const NaivePolygon part = naive_clip(polygon, cube);
  Eigen::Vector3d lowest_m = cube.max_m;
  for (const Eigen::Vector3d& corner_m : part) {
    lowest_m = lowest_m.cwiseMin(corner_m);
  }
  return !part.empty() && (lowest_m.array() < cube.max_m.array()).all();
}

/// The cube of a grid's cell.
inline NaiveCube naive_cube(const VoxelGrid& grid, const Eigen::Vector3i& cell) {
  const Eigen::Vector3d min_m = grid.min_m + grid.voxel_m * cell.cast<double>();
  return {min_m, min_m + Eigen::Vector3d::Constant(grid.voxel_m)};
}

/// Whether a triangle meets a cell, asked of a cube a little smaller and of one a little larger.
inline NaiveMeeting naive_meeting(const NaivePolygon& triangle,
                                  const NaiveCube& cube,
                                  double border_m) {
  const Eigen::Vector3d border = Eigen::Vector3d::Constant(border_m);
  if (!naive_clip(triangle, {cube.min_m + border, cube.max_m - border}).empty()) {
    return NaiveMeeting::kMeets;
  }
  return naive_clip(triangle, {cube.min_m - border, cube.max_m + border}).empty()
             ? NaiveMeeting::kApart
             : NaiveMeeting::kBorder;
}

/// The corners of a mesh's triangle.
inline NaivePolygon naive_polygon(const TriangleMesh& mesh,
                                  const std::array<std::uint32_t, 3>& triangle) {
  NaivePolygon polygon;
  for (const std::uint32_t vertex : triangle) {
    polygon.push_back(mesh.vertices_m[vertex].cast<double>());
  }
  return polygon;
}

/// How each cell of a grid, by position in memory, meets the triangles of a mesh.
inline std::vector<NaiveMeeting> naive_occupancy(const TriangleMesh& mesh,
                                                 const VoxelGrid& grid,
                                                 double border_m) {
  std::vector<NaiveMeeting> cells(static_cast<std::size_t>(grid.cell_count()),
                                  NaiveMeeting::kApart);
  for (const auto& triangle : mesh.triangles) {
    const NaivePolygon polygon = naive_polygon(mesh, triangle);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const NaiveCube cube = naive_cube(grid, grid.cell_at(static_cast<std::int64_t>(i)));
      const NaiveMeeting meeting = naive_meeting(polygon, cube, border_m);
      cells[i] = meeting > cells[i] ? meeting : cells[i];
    }
  }
  return cells;
}

}  // namespace skyhalo::reference
