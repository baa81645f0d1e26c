#include "skyhalo/evaluation/ground_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// f = 100, principal point (10, 5), 20 x 10 pixels.
TruthCamera small_camera() {
  TruthCamera camera;
  camera.focal_px = 100.0;
  camera.principal_u_px = 10.0;
  camera.principal_v_px = 5.0;
  camera.image_size_px = {20, 10};
  return camera;
}

TEST(GroundTruthTest, TheImageIsHalfOpen) {
  // At z = 100 m a metre is a pixel: u = 10 + x, v = 5 + y.
  const TruthCamera camera = small_camera();
  EXPECT_TRUE(is_seen(camera, {0.0, 0.0, 100.0}, 1000.0));
  EXPECT_TRUE(is_seen(camera, {-10.0, -5.0, 100.0}, 1000.0));  // u = v = 0
  EXPECT_FALSE(is_seen(camera, {-10.001, 0.0, 100.0}, 1000.0));
  EXPECT_FALSE(is_seen(camera, {0.0, -5.001, 100.0}, 1000.0));
  EXPECT_TRUE(is_seen(camera, {9.999, 4.999, 100.0}, 1000.0));
  EXPECT_FALSE(is_seen(camera, {10.0, 0.0, 100.0}, 1000.0));  // u = 20
  EXPECT_FALSE(is_seen(camera, {0.0, 5.0, 100.0}, 1000.0));   // v = 10
}

TEST(GroundTruthTest, WhatIsBehindIsNotSeen) {
  const TruthCamera camera = small_camera();
  EXPECT_FALSE(is_seen(camera, {0.0, 0.0, -1.0}, 1000.0));
  EXPECT_FALSE(is_seen(camera, {0.0, 0.0, 0.0}, 1000.0));
  EXPECT_TRUE(is_seen(camera, {0.0, 0.0, 1e-3}, 1000.0));
}

TEST(GroundTruthTest, TheRangeIsFromTheCamera) {
  const TruthCamera camera = small_camera();
  EXPECT_TRUE(is_seen(camera, {0.0, 0.0, 33.0}, 33.0));
  EXPECT_FALSE(is_seen(camera, {0.0, 0.0, 33.001}, 33.0));
  // Depth 32.9 m, but sqrt(32.9^2 + 3^2) = 33.04 m away.
  EXPECT_FALSE(is_seen(camera, {3.0, 0.0, 32.9}, 33.0));
}

TEST(GroundTruthTest, APointThatIsNotFiniteIsNotSeen) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TruthCamera camera = small_camera();
  EXPECT_FALSE(is_seen(camera, {kNan, 0.0, 10.0}, 33.0));
  EXPECT_FALSE(is_seen(camera, {0.0, kNan, 10.0}, 33.0));
  EXPECT_FALSE(is_seen(camera, {0.0, 0.0, kNan}, 33.0));
  EXPECT_FALSE(is_seen(camera, {0.0, 0.0, kInfinity}, 33.0));
}

/// A camera of a right angle that looks along the scanner's x; the map is the scanner's frame moved
/// by 1 m in x.
TruthView simple_view() {
  TruthView view;
  view.camera.focal_px = 50.0;
  view.camera.principal_u_px = 50.0;
  view.camera.principal_v_px = 50.0;
  view.camera.image_size_px = {100, 100};
  Eigen::Matrix3d R;
  R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  view.camera.T_camera_laser = make_pose(R, Eigen::Vector3d::Zero());
  view.T_annotation_laser = view.camera.T_camera_laser;
  view.T_map_laser = make_pose(Eigen::Matrix3d::Identity(), {1.0, 0.0, 0.0});
  view.max_range_m = 8.0;
  return view;
}

/// Ten cells along x, 0...10 m, one across.
VoxelGrid row_of_cells() {
  return {.min_m = {0.0, -0.5, -0.5}, .voxel_m = 1.0, .size = {10, 1, 1}};
}

TEST(GroundTruthTest, APointMarksItsCellInTheMap) {
  // The scanner's x = 2.5 is the map's 3.5: cell 3.
  EXPECT_THAT(occupied_cells({{2.5F, 0.0F, 0.0F}}, simple_view(), {}, row_of_cells()),
              ElementsAre(3));
}

TEST(GroundTruthTest, ARayObservesTheCellsOnItsWayAndItsEnd) {
  // From the map's x = 1 to x = 3.5.
  EXPECT_THAT(observed_cells({{2.5F, 0.0F, 0.0F}}, simple_view(), row_of_cells()),
              ElementsAre(0, 1, 1, 1, 0, 0, 0, 0, 0, 0));
}

TEST(GroundTruthTest, ARayIsFollowedUpToTheRange) {
  TruthView view = simple_view();
  view.max_range_m = 4.5;  // to the map's x = 5.5, though the point is at 21
  EXPECT_THAT(observed_cells({{20.0F, 0.0F, 0.0F}}, view, row_of_cells()),
              ElementsAre(0, 1, 1, 1, 1, 1, 0, 0, 0, 0));
}

TEST(GroundTruthTest, ARayOutsideTheImageObservesNothing) {
  EXPECT_THAT(
      observed_cells({{-2.5F, 0.0F, 0.0F}, {1.0F, 5.0F, 0.0F}}, simple_view(), row_of_cells()),
      ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(GroundTruthTest, CellsAreSortedAndEachComesOnce) {
  const LaserScan scan{{5.5F, 0.0F, 0.0F},
                       {2.5F, 0.0F, 0.0F},
                       {5.6F, 0.1F, 0.1F},
                       {2.5F, 0.0F, 0.0F},
                       {0.5F, 0.0F, 0.0F}};
  EXPECT_THAT(occupied_cells(scan, simple_view(), {}, row_of_cells()), ElementsAre(1, 3, 6));
}

TEST(GroundTruthTest, PointsThatDoNotCountAreLeftOut) {
  const LaserScan scan{
      {-2.0F, 0.0F, 0.0F},  // behind the camera
      {0.3F, 0.4F, 0.0F},   // 53 deg to the left, outside the image
      {8.5F, 0.0F, 0.0F},   // beyond 8 m, though the map reaches to 9 m
      {4.5F, 0.6F, 0.0F},   // beside the map
      {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F},
  };
  EXPECT_THAT(occupied_cells(scan, simple_view(), {}, row_of_cells()), IsEmpty());
  EXPECT_THAT(occupied_cells({}, simple_view(), {}, row_of_cells()), IsEmpty());
}

TEST(GroundTruthTest, PointsInABoxAreLeftOut) {
  // In the camera frame the scanner's x is depth z: a box from z = 2 to 4, 1 m wide and high about
  // the axis.
  OrientedBox box;
  box.corner_m = {-0.5, -0.5, 2.0};
  box.edges_m = Eigen::Vector3d(1.0, 1.0, 2.0).asDiagonal();
  OrientedBox far_box = box;
  far_box.corner_m.z() = 6.0;
  const LaserScan scan{{1.5F, 0.0F, 0.0F},
                       {2.5F, 0.0F, 0.0F},
                       {3.5F, 0.2F, 0.2F},
                       {4.5F, 0.0F, 0.0F},
                       {6.5F, 0.0F, 0.0F}};
  const VoxelGrid grid = row_of_cells();
  const std::vector<OrientedBox> one{box};
  EXPECT_THAT(occupied_cells(scan, simple_view(), one, grid), ElementsAre(2, 5, 7));
  const std::vector<OrientedBox> both{far_box, box};
  EXPECT_THAT(occupied_cells(scan, simple_view(), both, grid), ElementsAre(2, 5));
}

TEST(GroundTruthTest, ABoxHidesOnlyItsOwnPointsNotItsCell) {
  // Both points lie in cell 3; the box holds one of them.
  OrientedBox box;
  box.corner_m = {-0.5, -0.5, 2.0};
  box.edges_m = Eigen::Vector3d(1.0, 1.0, 0.5).asDiagonal();
  const std::vector<OrientedBox> boxes{box};
  EXPECT_THAT(occupied_cells(
                  {{2.25F, 0.0F, 0.0F}, {2.75F, 0.0F, 0.0F}}, simple_view(), boxes, row_of_cells()),
              ElementsAre(3));
}

TEST(GroundTruthTest, StartsFree) {
  const GroundTruth truth(row_of_cells());
  EXPECT_EQ(truth.occupied().size(), 10U);
  EXPECT_THAT(truth.occupied(), ::testing::Each(0));
  EXPECT_THAT(truth.occupied_offsets(), IsEmpty());
  EXPECT_EQ(truth.grid().size, Eigen::Vector3i(10, 1, 1));
}

TEST(GroundTruthTest, MarkingTwiceIsMarkingOnce) {
  GroundTruth truth(row_of_cells());
  truth.mark(std::vector<std::int64_t>{2, 7});
  truth.mark(std::vector<std::int64_t>{7, 0});
  truth.mark(std::vector<std::int64_t>{});
  EXPECT_THAT(truth.occupied(), ElementsAre(1, 0, 1, 0, 0, 0, 0, 1, 0, 0));
  EXPECT_THAT(truth.occupied_offsets(), ElementsAre(0, 2, 7));
}

TEST(GroundTruthProperty, MorePointsNeverMarkFewerCells) {
  std::mt19937 random(26);
  std::uniform_real_distribution<float> length(-9.0F, 9.0F);
  const VoxelGrid grid{.min_m = {-5.0, -5.0, -5.0}, .voxel_m = 0.5, .size = {30, 20, 20}};
  LaserScan scan;
  std::vector<std::int64_t> before;
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 50; ++i) {
      scan.emplace_back(length(random), length(random), length(random));
    }
    const std::vector<std::int64_t> cells = occupied_cells(scan, simple_view(), {}, grid);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    EXPECT_TRUE(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
    EXPECT_TRUE(std::includes(cells.begin(), cells.end(), before.begin(), before.end()));
    before = cells;
  }
  EXPECT_GT(before.size(), 50U);
}

}  // namespace
}  // namespace skyhalo
