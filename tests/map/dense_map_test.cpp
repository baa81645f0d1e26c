#include "skyhalo/map/dense_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace skyhalo {
namespace {

/// 4 x 3 x 2 cells of 0.5 m from (-1, 0, 10).
VoxelGrid small_grid() {
  return make_voxel_grid({Eigen::Vector3d(-1.0, 0.0, 10.0), Eigen::Vector3d(1.0, 1.5, 11.0)}, 0.5);
}

DenseMap map_of_fives() {
  DenseMap map(small_grid());
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    map.at(offset) = 5;
  }
  return map;
}

TEST(DenseMapTest, BeginsUnknown) {
  const DenseMap map(small_grid());
  EXPECT_EQ(map.cells().size(), 24U);
  EXPECT_TRUE(
      std::all_of(map.cells().begin(), map.cells().end(), [](LogOdds c) { return c == kUnknown; }));
}

TEST(DenseMapTest, TheReferenceMapOfTheThesisTakesTwoBytesACell) {
  // METHOD 6: 320 000 cells, 625 KiB.
  const DenseMap map(
      make_voxel_grid({Eigen::Vector3d(0.0, -20.0, -5.0), Eigen::Vector3d(100.0, 20.0, 5.0)}, 0.5));
  EXPECT_EQ(map.cells().size_bytes(), 625U * 1024U);
}

TEST(DenseMapTest, HeightRunsFastestInMemory) {
  DenseMap map(small_grid());
  map.at(0) = 1;
  map.at(1) = 2;
  map.at(2) = 3;
  map.at(6) = 4;
  EXPECT_EQ(map.at_point({-0.75, 0.25, 10.25}), 1);
  EXPECT_EQ(map.at_point({-0.75, 0.25, 10.75}), 2);
  EXPECT_EQ(map.at_point({-0.75, 0.75, 10.25}), 3);
  EXPECT_EQ(map.at_point({-0.25, 0.25, 10.25}), 4);
  EXPECT_EQ(map.cells()[6], 4);
}

TEST(DenseMapTest, APointIsInItsHalfOpenCell) {
  DenseMap map(small_grid());
  map.at(map.grid().offset_of({2, 1, 1})) = 77;
  EXPECT_EQ(map.at_point({0.0, 0.5, 10.5}), 77);
  EXPECT_EQ(map.at_point({0.499, 0.999, 10.999}), 77);
  EXPECT_EQ(map.at_point({-0.001, 0.5, 10.5}), kUnknown);
  EXPECT_EQ(map.at_point({0.5, 0.5, 10.5}), kUnknown);
}

TEST(DenseMapTest, OutsideIsUnknown) {
  const DenseMap map = map_of_fives();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(map.at_point({0.0, 0.0, 10.0}), 5);
  EXPECT_EQ(map.at_point({1.0, 0.5, 10.5}), kUnknown);
  EXPECT_EQ(map.at_point({-1.001, 0.5, 10.5}), kUnknown);
  EXPECT_EQ(map.at_point({0.0, 0.5, 11.0}), kUnknown);
  EXPECT_EQ(map.at_point({kNan, 0.5, 10.5}), kUnknown);
  EXPECT_EQ(map.at_point({0.0, -kInf, 10.5}), kUnknown);
  EXPECT_EQ(map.at_point({0.0, 0.5, 1e300}), kUnknown);
}

TEST(DenseMapProperty, EveryCellAnswersAtItsCentre) {
  DenseMap map(small_grid());
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    map.at(offset) = static_cast<LogOdds>(offset);
  }
  for (std::int64_t offset = 0; offset < map.grid().cell_count(); ++offset) {
    EXPECT_EQ(map.at_point(map.grid().center_m(map.grid().cell_at(offset))), offset);
  }
}

}  // namespace
}  // namespace skyhalo
