#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "reference/naive_occupancy.hpp"
#include "skyhalo/sim/exact_occupancy.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;
using reference::naive_cube;
using reference::naive_meeting;
using reference::naive_meets_half_open;
using reference::naive_occupancy;
using reference::NaiveMeeting;
using reference::NaivePolygon;
using testing::random_point_m;

Eigen::Matrix3d columns_of(const NaivePolygon& triangle) {
  Eigen::Matrix3d corners_m;
  corners_m << triangle[0], triangle[1], triangle[2];
  return corners_m;
}

TriangleMesh one_triangle(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  TriangleMesh mesh;
  mesh.vertices_m = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  return mesh;
}

VoxelGrid random_grid(std::mt19937& rng) {
  std::uniform_real_distribution<double> edge(0.11, 0.9);
  std::uniform_int_distribution<int> count(1, 9);
  const int x = count(rng);
  const int y = count(rng);
  return {random_point_m(rng, 2.0), edge(rng), {x, y, count(rng)}};
}

struct Agreement {
  int full = 0;
  int empty = 0;
  int border = 0;
};

void expect_same(const TriangleMesh& mesh, const VoxelGrid& grid, Agreement& found) {
  const std::vector<std::uint8_t> fast = exact_occupancy(mesh, grid);
  const std::vector<NaiveMeeting> naive = naive_occupancy(mesh, grid, 1e-9);
  ASSERT_EQ(fast.size(), naive.size());
  for (std::size_t i = 0; i < naive.size(); ++i) {
    if (naive[i] == NaiveMeeting::kBorder) {
      ++found.border;
      continue;
    }
    const bool meets = naive[i] == NaiveMeeting::kMeets;
    ++(meets ? found.full : found.empty);
    ASSERT_EQ(fast[i], meets ? 1 : 0)
        << "cell " << grid.cell_at(static_cast<std::int64_t>(i)).transpose() << " of a grid at "
        << grid.min_m.transpose() << " with cells of " << grid.voxel_m << " m";
  }
}

void expect_same_of_soups(double half_edge_m, double size_m, int trials) {
  std::mt19937 rng(static_cast<std::uint32_t>(100.0 * size_m));
  Agreement found;
  for (int i = 0; i < trials; ++i) {
    const TriangleMesh mesh = testing::random_soup(rng, 6, half_edge_m, size_m);
    expect_same(mesh, random_grid(rng), found);
  }
  EXPECT_GT(found.full, trials / 4);
  EXPECT_GT(found.empty, trials);
  EXPECT_LE(found.border, 2);
}

TEST(ExactOccupancyReference, SmallTriangles) {
  expect_same_of_soups(3.0, 0.05, 100);
}

TEST(ExactOccupancyReference, TrianglesOfSomeCells) {
  expect_same_of_soups(3.0, 1.5, 100);
}

TEST(ExactOccupancyReference, LargeTriangles) {
  expect_same_of_soups(5.0, 30.0, 100);
}

// Their middles are near the grid, their corners up to kilometres away.
TEST(ExactOccupancyReference, HugeTriangles) {
  std::mt19937 rng(29);
  Agreement found;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d a = random_point_m(rng, 2000.0);
    const Eigen::Vector3d b = random_point_m(rng, 2000.0);
    const Eigen::Vector3d c = random_point_m(rng, 2.0) - a - b;
    const TriangleMesh mesh = one_triangle(a.cast<float>(), b.cast<float>(), c.cast<float>());
    expect_same(mesh, random_grid(rng), found);
  }
  EXPECT_GT(found.full, 100);
  EXPECT_GT(found.empty, 100);
}

TEST(ExactOccupancyReference, TrianglesOutsideFillNothing) {
  std::mt19937 rng(31);
  for (int i = 0; i < 50; ++i) {
    TriangleMesh mesh = testing::random_soup(rng, 5, 3.0, 1.0);
    for (Vector3f& vertex_m : mesh.vertices_m) {
      vertex_m[i % 3] += i % 2 == 0 ? 30.0F : -30.0F;
    }
    const std::vector<std::uint8_t> fast = exact_occupancy(mesh, random_grid(rng));
    EXPECT_EQ(std::count(fast.begin(), fast.end(), 1), 0);
  }
}

TEST(ExactOccupancyReference, AxisParallelTriangles) {
  std::mt19937 rng(33);
  Agreement found;
  for (int i = 0; i < 150; ++i) {
    TriangleMesh mesh = testing::random_soup(rng, 4, 3.0, 2.0);
    for (std::size_t k = 0; k < mesh.vertices_m.size(); ++k) {
      mesh.vertices_m[k][i % 3] = mesh.vertices_m[3 * (k / 3)][i % 3];
    }
    expect_same(mesh, random_grid(rng), found);
  }
  EXPECT_GT(found.full, 150);
}

TEST(ExactOccupancyReference, TrianglesWithoutAnArea) {
  std::mt19937 rng(35);
  Agreement found;
  for (int i = 0; i < 150; ++i) {
    TriangleMesh mesh = testing::random_soup(rng, 4, 3.0, 2.0);
    for (std::size_t k = 0; k < mesh.vertices_m.size(); k += 3) {
      mesh.vertices_m[k + 2] = mesh.vertices_m[k + 1];
      if (i % 3 == 0) {
        mesh.vertices_m[k + 1] = mesh.vertices_m[k];
        mesh.vertices_m[k + 2] = mesh.vertices_m[k];
      }
    }
    expect_same(mesh, random_grid(rng), found);
  }
  EXPECT_GT(found.full, 100);
}

/// Triangles with corners at multiples of half a cell that differ by 0, 1, 2 or 4 halves along the
/// axes, so that clipping is exact; every third one lies in a face between cells.
std::vector<NaivePolygon> lattice_triangles(const VoxelGrid& grid) {
  std::mt19937 rng(37);
  std::uniform_int_distribution<int> start(0, 8);
  std::uniform_int_distribution<std::size_t> which(0, 5);
  const std::array<double, 6> steps = {-4.0, -2.0, -1.0, 1.0, 2.0, 4.0};
  std::vector<NaivePolygon> triangles;
  for (int i = 0; i < 400; ++i) {
    const int x = start(rng);
    const int y = start(rng);
    const Vector3d first = grid.min_m + 0.5 * grid.voxel_m * Vector3d(x, y, start(rng));
    const auto moved = [&](int axis) -> Vector3d {
      Vector3d other = first;
      other[axis] += 0.5 * grid.voxel_m * steps[which(rng)];
      return other;
    };
    triangles.push_back({first, moved(i % 3), moved((i + 1) % 3)});
  }
  return triangles;
}

/// Whether all that a triangle and a cell, faces included, share is a single point.
bool share_a_point_only(const NaivePolygon& triangle, const reference::NaiveCube& cube) {
  const NaivePolygon part = reference::naive_clip(triangle, cube);
  return !part.empty() && std::all_of(part.begin(), part.end(), [&](const Vector3d& corner_m) {
    return corner_m == part.front();
  });
}

TEST(ExactOccupancyReference, FacesOnTheLatticeFollowTheHalfOpenCells) {
  const VoxelGrid grid{Vector3d(-1.0, 0.5, 2.0), 0.5, {6, 6, 6}};
  int met = 0;
  for (const NaivePolygon& triangle : lattice_triangles(grid)) {
    const TriangleMesh mesh = one_triangle(
        triangle[0].cast<float>(), triangle[1].cast<float>(), triangle[2].cast<float>());
    const std::vector<std::uint8_t> fast = exact_occupancy(mesh, grid);
    for (std::int64_t offset = 0; offset < grid.cell_count(); ++offset) {
      const reference::NaiveCube cube = naive_cube(grid, grid.cell_at(offset));
      const bool naive = naive_meets_half_open(triangle, cube);
      met += naive ? 1 : 0;
      if (naive || !share_a_point_only(triangle, cube)) {
        ASSERT_EQ(fast[static_cast<std::size_t>(offset)] == 1, naive)
            << grid.cell_at(offset).transpose() << " of\n"
            << columns_of(triangle);
      }
    }
  }
  EXPECT_GT(met, 400);
}

TEST(ExactOccupancyReference, SingleCellsAgree) {
  std::mt19937 rng(39);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const VoxelGrid grid = random_grid(rng);
    const NaivePolygon triangle = {
        random_point_m(rng, 3.0), random_point_m(rng, 3.0), random_point_m(rng, 3.0)};
    const Vector3i cell = grid.cell_at(i % grid.cell_count());
    const NaiveMeeting naive = naive_meeting(triangle, naive_cube(grid, cell), 1e-9);
    if (naive != NaiveMeeting::kBorder) {
      ASSERT_EQ(meets_cell(columns_of(triangle), grid, cell), naive == NaiveMeeting::kMeets);
      met += naive == NaiveMeeting::kMeets ? 1 : 0;
    }
  }
  EXPECT_GT(met, 30);
}

TEST(ExactOccupancyTest, AWallOnACellsFaceFillsTheCellsAboveItOnly) {
  const VoxelGrid grid{Vector3d::Zero(), 0.5, {4, 4, 4}};
  // In the plane x = 1, from (0.6, 0.6) to (0.9, 0.9): inside the cells' second row in y and z.
  const TriangleMesh mesh =
      one_triangle({1.0F, 0.6F, 0.6F}, {1.0F, 0.9F, 0.6F}, {1.0F, 0.6F, 0.9F});
  const std::vector<std::uint8_t> cells = exact_occupancy(mesh, grid);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 1);
  EXPECT_EQ(cells[static_cast<std::size_t>(grid.offset_of({2, 1, 1}))], 1);
}

TEST(ExactOccupancyTest, ABoxIsHollow) {
  // A box from 0.6 to 2.4 in a grid of 0.5: cells 1...4 along each axis, 4^3 without the inner 2^3.
  TriangleMesh mesh;
  add_box(mesh, {.middle_m = Vector3f::Constant(1.5F), .size_m = Vector3f::Constant(1.8F)}, {});
  const VoxelGrid grid{Vector3d::Zero(), 0.5, {6, 6, 6}};
  const std::vector<std::uint8_t> cells = exact_occupancy(mesh, grid);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 64 - 8);
  EXPECT_EQ(cells[static_cast<std::size_t>(grid.offset_of({2, 2, 3}))], 0);
  EXPECT_EQ(cells[static_cast<std::size_t>(grid.offset_of({1, 4, 2}))], 1);
}

}  // namespace
}  // namespace skyhalo
