#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "reference/naive_ray_tracer.hpp"
#include "skyhalo/sim/seen_cells.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;
using reference::naive_trace;
using reference::naive_triangles;
using reference::NaiveHit;
using reference::NaiveTriangle;

constexpr PinholePair kPinhole{20.0, 15.5, 11.5, 0.3, 0.0};
constexpr SphericalPair kSpherical{0.07, 0.06, 15.5, 11.5, 0.3};
const cv::Size kSizePx(32, 24);

/// How much of a ray lies in a grid's cells, found by small steps.
struct CellViews {
  std::vector<double> crossed_m;  ///< the longest piece of one ray in the cell
  std::vector<int> blocks;        ///< 4 x 4 blocks of pixels whose rays all cross it by 10 cm
  std::vector<int> near;          ///< 1 where a ray passes within 1 mm, its end included
};

/// The cells along one ray up to its end, in steps of 5 mm, each given 5 mm of it.
void add_naive_ray(const VoxelGrid& grid,
                   const Vector3d& origin_m,
                   const Vector3d& along,
                   double end_m,
                   std::vector<double>& crossed_m) {
  for (double s_m = 0.0025; s_m < end_m; s_m += 0.005) {
    const Vector3i cell = grid.cell_of(origin_m + s_m * along);
    if (grid.holds(cell)) {
      crossed_m[static_cast<std::size_t>(grid.offset_of(cell))] += 0.005;
    }
  }
}

/// Marks the cells within 1 mm of a ray up to 1 mm behind its end: a slab test of each cell.
void add_naive_touches(const VoxelGrid& grid,
                       const Vector3d& origin_m,
                       const Vector3d& along,
                       double end_m,
                       std::vector<int>& near) {
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Vector3i cell = grid.cell_at(static_cast<std::int64_t>(i));
    double enter_m = 0.0;
    double leave_m = end_m + 1e-3;
    for (int axis = 0; axis < 3; ++axis) {
      const double low_m = grid.min_m[axis] + grid.voxel_m * cell[axis] - 1e-3;
      const double high_m = low_m + grid.voxel_m + 2e-3;
      const double first = (low_m - origin_m[axis]) / along[axis];
      const double second = (high_m - origin_m[axis]) / along[axis];
      enter_m = std::max(enter_m, std::min(first, second));
      leave_m = std::min(leave_m, std::max(first, second));
    }
    near[i] |= enter_m <= leave_m ? 1 : 0;
  }
}

/// What the pixels of a camera see of a grid up to a range.
CellViews naive_views(const std::vector<NaiveTriangle>& triangles,
                      const PairModel& pair,
                      const Pose& T_scene_camera,
                      const VoxelGrid& grid,
                      double max_range_m) {
  const auto count = static_cast<std::size_t>(grid.cell_count());
  CellViews views{
      std::vector<double>(count, 0.0), std::vector<int>(count, 0), std::vector<int>(count, 0)};
  for (int row = 0; row < kSizePx.height; row += 4) {
    for (int col = 0; col < kSizePx.width; col += 4) {
      std::vector<double> least_m(count, 1e9);
      for (int pixel = 0; pixel < 16; ++pixel) {
        const Vector3d along =
            T_scene_camera.linear() * ray_of(pair, col + pixel % 4, row + pixel / 4);
        const NaiveHit hit = naive_trace(triangles, T_scene_camera.translation(), along);
        const double end_m = std::min(hit.range_m, max_range_m);
        const double sure_m = hit.edge_distance < 1e-3 ? 0.0 : end_m;
        std::vector<double> crossed_m(count, 0.0);
        add_naive_ray(grid, T_scene_camera.translation(), along, sure_m, crossed_m);
        add_naive_touches(grid,
                          T_scene_camera.translation(),
                          along,
                          hit.edge_distance < 1e-3 ? max_range_m : end_m,
                          views.near);
        for (std::size_t i = 0; i < count; ++i) {
          views.crossed_m[i] = std::max(views.crossed_m[i], crossed_m[i]);
          least_m[i] = std::min(least_m[i], crossed_m[i]);
        }
      }
      for (std::size_t i = 0; i < count; ++i) {
        views.blocks[i] += least_m[i] > 0.1 ? 1 : 0;
      }
    }
  }
  return views;
}

std::vector<std::uint8_t> fast_seen(const Scene& scene,
                                    const PairModel& pair,
                                    const Pose& T_scene_camera,
                                    const VoxelGrid& grid,
                                    const SeenCellsConfig& config) {
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  SeenCells cells(grid);
  cells.add(moment, pair, kSizePx, T_scene_camera, config);
  return {cells.seen().begin(), cells.seen().end()};
}

void expect_seen(const PairModel& pair) {
  std::mt19937 rng(81);
  int marked = 0;
  int unmarked = 0;
  int whole_blocks = 0;
  for (std::uint32_t seed = 90; seed < 93; ++seed) {
    const Scene scene = testing::random_scene(seed, 25, 3.0, 1.5);
    const Pose T_scene_camera =
        make_pose(testing::random_rotation(rng), testing::random_point_m(rng, 2.0));
    const VoxelGrid grid{Vector3d(-3.01, -2.97, -3.03), 0.5, {12, 12, 12}};
    const CellViews naive =
        naive_views(naive_triangles(scene, {0.0, 0.0}, 0.0), pair, T_scene_camera, grid, 4.0);
    const auto each = fast_seen(scene,
                                pair,
                                T_scene_camera,
                                grid,
                                {.max_range_m = 4.0, .hit_step_px = 1, .walk_step_px = 1});
    const auto some = fast_seen(scene, pair, T_scene_camera, grid, {.max_range_m = 4.0});
    for (std::size_t i = 0; i < each.size(); ++i) {
      const Vector3i cell = grid.cell_at(static_cast<std::int64_t>(i));
      EXPECT_LE(each[i], naive.near[i]) << cell.transpose() << " is seen by no pixel";
      EXPECT_LE(some[i], each[i]) << cell.transpose() << " is seen by no pixel in steps";
      if (naive.crossed_m[i] > 0.02) {
        EXPECT_EQ(each[i], 1) << cell.transpose() << " is crossed by " << naive.crossed_m[i];
      }
      if (naive.blocks[i] > 0) {
        EXPECT_EQ(some[i], 1) << cell.transpose() << " is crossed by 16 pixels in a block";
      }
      ++(each[i] == 1 ? marked : unmarked);
      whole_blocks += naive.blocks[i] > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(marked, 300);
  EXPECT_GT(unmarked, 300);
  EXPECT_GT(whole_blocks, 50);
}

TEST(SeenCellsReference, PinholeCamerasSeeWhatTheirRaysCross) {
  expect_seen(kPinhole);
}

TEST(SeenCellsReference, SphericalCamerasSeeWhatTheirRaysCross) {
  expect_seen(kSpherical);
}

/// A camera at the origin that looks along x.
Pose facing_x() {
  Eigen::Matrix3d R;
  R << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return make_pose(R, Vector3d::Zero());
}

/// A wall square to x, this far ahead of the origin.
Scene big_wall(float x_m) {
  Scene scene;
  scene.name = "wall";
  scene.materials.resize(1);
  add_quad(scene.fixed,
           {Vector3f(x_m, 50.0F, -50.0F),
            Vector3f(x_m, -50.0F, -50.0F),
            Vector3f(x_m, -50.0F, 50.0F),
            Vector3f(x_m, 50.0F, 50.0F)},
           {});
  return scene;
}

TEST(SeenCellsTest, AWallIsSeenAndNothingBehindIt) {
  // Cells of 0.5 m along x, the wall in the cell from 5 to 5.5.
  const VoxelGrid grid{Vector3d(0.0, -0.25, -0.25), 0.5, {20, 1, 1}};
  const auto seen = fast_seen(big_wall(5.2F), kPinhole, facing_x(), grid, {});
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(seen[i], i <= 10 ? 1 : 0) << i;
  }
}

TEST(SeenCellsTest, NothingIsSeenBeyondTheRange) {
  const VoxelGrid grid{Vector3d(0.0, -0.25, -0.25), 0.5, {20, 1, 1}};
  const auto seen = fast_seen(big_wall(5.2F), kPinhole, facing_x(), grid, {.max_range_m = 3.2});
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(seen[i], i <= 6 ? 1 : 0) << i;
  }
  const auto sky = fast_seen(big_wall(-5.0F), kPinhole, facing_x(), grid, {.max_range_m = 8.2});
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(sky[i], i <= 16 ? 1 : 0) << i;
  }
}

TEST(SeenCellsTest, SeveralCamerasAddUp) {
  const Scene scene = big_wall(30.0F);
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const VoxelGrid grid{Vector3d(-5.0, -0.25, -0.25), 0.5, {20, 1, 1}};
  SeenCells cells(grid);
  EXPECT_EQ(std::count(cells.seen().begin(), cells.seen().end(), 1), 0);
  cells.add(moment, kPinhole, kSizePx, facing_x(), {});
  EXPECT_EQ(std::count(cells.seen().begin(), cells.seen().end(), 1), 10);
  const Eigen::AngleAxisd round(std::acos(-1.0), Vector3d::UnitZ());
  cells.add(moment, kPinhole, kSizePx, Pose(round) * facing_x(), {});
  EXPECT_EQ(std::count(cells.seen().begin(), cells.seen().end(), 1), 20);
}

}  // namespace
}  // namespace skyhalo
