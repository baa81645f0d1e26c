#include "skyhalo/io/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <memory>
#include <random>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

VoxelGrid grid_of(const Eigen::Vector3d& min_m, const Eigen::Vector3i& size, double voxel_m) {
  return {.min_m = min_m, .voxel_m = voxel_m, .size = size};
}

std::unique_ptr<octomap::OcTree> read_octree(const std::filesystem::path& file) {
  std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file.string()));
  auto* const octree = dynamic_cast<octomap::OcTree*>(tree.get());
  if (octree != nullptr) {
    (void)tree.release();
  }
  return std::unique_ptr<octomap::OcTree>(octree);
}

/// Writes a map and expects the octree to hold just its observed cells, with their log odds.
void expect_same_cells(const DenseMap& map) {
  const TempFolder folder;
  write_octree(folder.path() / "map.ot", map);
  const auto tree = read_octree(folder.path() / "map.ot");
  ASSERT_NE(tree, nullptr);
  EXPECT_DOUBLE_EQ(tree->getResolution(), map.grid().voxel_m);
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    const Eigen::Vector3d p_m = map.grid().center_m(map.grid().cell_at(offset));
    const LogOdds cell = map.at_point(p_m);
    const octomap::OcTreeNode* const node = tree->search(p_m.x(), p_m.y(), p_m.z());
    ASSERT_EQ(node != nullptr, cell != kUnknown) << p_m.transpose();
    if (node != nullptr) {
      ASSERT_NEAR(node->getLogOdds(), 0.001 * cell, 1e-6) << p_m.transpose();
    }
  }
}

TEST(MapFileTest, OccupiedPointsAreTheCentresAboveTheProbability) {
  DenseMap map(grid_of({10.0, -1.0, 0.0}, {2, 2, 2}, 0.5));
  map.at(0) = 900;    // p = 0.711
  map.at(3) = 800;    // p = 0.690
  map.at(5) = -3000;  // free
  map.at(7) = 5000;
  // Cell 0 is (0, 0, 0), cell 7 is (1, 1, 1); centres lie half a voxel inside.
  const std::vector<ColouredPoint> points = occupied_points(map, 0.7);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].position_m, Eigen::Vector3f(10.25F, -0.75F, 0.25F));
  EXPECT_EQ(points[1].position_m, Eigen::Vector3f(10.75F, -0.25F, 0.75F));
}

TEST(MapFileTest, AnUnknownCellIsNoOccupiedPoint) {
  // An unknown cell reads as 0.5, which is above 0.4; still nothing is known of it.
  DenseMap map(grid_of({0.0, 0.0, 0.0}, {1, 1, 2}, 1.0));
  map.at(1) = 0;
  const std::vector<ColouredPoint> points = occupied_points(map, 0.4);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].position_m, Eigen::Vector3f(0.5F, 0.5F, 1.5F));
}

TEST(MapFileTest, PointsAreColouredByHeight) {
  const VoxelGrid grid = grid_of({0.0, 0.0, 0.0}, {2, 1, 3}, 1.0);
  const std::vector<ColouredPoint> points = cell_points(grid, {0, 2, 3, 5});
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0].colour_bgr, points[2].colour_bgr);  // both at z = 0.5
  EXPECT_EQ(points[1].colour_bgr, points[3].colour_bgr);  // both at z = 2.5
  EXPECT_NE(points[0].colour_bgr, points[1].colour_bgr);
  EXPECT_EQ(points[3].position_m, Eigen::Vector3f(1.5F, 0.5F, 2.5F));
}

TEST(MapFileTest, OctomapReadsTheCells) {
  DenseMap map(grid_of({-1.0, -2.0, 0.5}, {4, 3, 2}, 0.5));
  map.at(0) = 1500;
  map.at(5) = -1250;
  map.at(23) = 0;
  expect_same_cells(map);
}

TEST(MapFileTest, SureCellsKeepTheirLogOdds) {
  // Log odds up to +-5 are what the detector writes; OctoMap's own limits are -2 and 3.5.
  DenseMap map(grid_of({0.0, 0.0, 0.0}, {3, 1, 1}, 0.5));
  map.at(0) = 5000;
  map.at(1) = -5000;
  map.at(2) = 3000;
  expect_same_cells(map);
}

TEST(MapFileTest, EqualNeighboursStayReadable) {
  // Eight equal children of one node may be merged; each must still be found.
  DenseMap map(grid_of({0.0, 0.0, 0.0}, {4, 4, 4}, 1.0));
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    map.at(offset) = -1000;
  }
  expect_same_cells(map);
}

TEST(MapFileTest, CellsGoToTheOctreeCellThatHoldsTheirCentre) {
  // The grid starts at 0.375, so its one cell has the centre 0.625, in the octree's cell [0.5, 1).
  DenseMap map(grid_of({0.375, 0.375, 0.375}, {1, 1, 1}, 0.5));
  map.at(0) = 1000;
  const TempFolder folder;
  write_octree(folder.path() / "map.ot", map);
  const auto tree = read_octree(folder.path() / "map.ot");
  ASSERT_NE(tree, nullptr);
  EXPECT_NE(tree->search(0.95, 0.55, 0.75), nullptr);
  EXPECT_EQ(tree->search(0.45, 0.75, 0.75), nullptr);
}

TEST(MapFileTest, AMapOffTheLatticeLosesNoCell) {
  // The corner lies half a cell off the octree's lattice, where centres fall on the faces of its
  // cells.
  DenseMap map(grid_of({0.05, 0.05, 0.05}, {8, 8, 8}, 0.1));
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    map.at(offset) = static_cast<LogOdds>(offset);  // all different, so that nothing is pruned
  }
  const TempFolder folder;
  write_octree(folder.path() / "map.ot", map);
  const auto tree = read_octree(folder.path() / "map.ot");
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getNumLeafNodes(), 512U);
}

TEST(MapFileTest, AnEmptyMapIsAValidFile) {
  expect_same_cells(DenseMap(grid_of({0.0, 0.0, 0.0}, {2, 2, 2}, 0.5)));
}

TEST(MapFileTest, AMapBeyondTheOctreesRangeIsAFailure) {
  // 32768 cells of 0.5 m reach to 16384 m.
  DenseMap map(grid_of({16384.0, 0.0, 0.0}, {1, 1, 1}, 0.5));
  map.at(0) = 1000;
  const TempFolder folder;
  const auto file = folder.path() / "map.ot";
  EXPECT_THAT(message_of([&] { write_octree(file, map); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(MapFileTest, AFileThatCannotBeWrittenIsAFailure) {
  const TempFolder folder;
  const DenseMap map(grid_of({0.0, 0.0, 0.0}, {1, 1, 1}, 0.5));
  const auto file = folder.path() / "missing" / "map.ot";
  EXPECT_THAT(message_of([&] { write_octree(file, map); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
}

TEST(MapFileProperty, ARandomMapIsReadBack) {
  std::mt19937 random(4);
  std::uniform_int_distribution value(-5000, 5000);
  DenseMap map(grid_of({-2.0, -2.0, -1.0}, {9, 8, 7}, 0.25));
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    if (value(random) > 0) {
      map.at(offset) = static_cast<LogOdds>(value(random));
    }
  }
  expect_same_cells(map);
}

}  // namespace
}  // namespace skyhalo
