#include "skyhalo/io/map_statistics.hpp"

#include <gtest/gtest.h>

namespace skyhalo {
namespace {

constexpr OccupancyRule kRule{.occupied_above = 800, .free_below = 0};

TEST(MapStatisticsTest, CellsAndBricksAreCounted) {
  SparseMap map({.voxel_m = 0.5});
  map.set_uniform({2, 0, 0}, -2000);
  map.set({-5, 3, 100}, 4000);
  map.set({-5, 3, 101}, 300);
  map.set({0, 0, 0}, -1);
  const MapStatistics found = statistics_of(map, kRule);
  EXPECT_EQ(found.bricks, 3U);
  EXPECT_EQ(found.uniform_bricks, 1U);
  EXPECT_EQ(found.known_cells, 515U);
  EXPECT_EQ(found.free_cells, 513U);
  EXPECT_EQ(found.occupied_cells, 1U);
  EXPECT_EQ(found.known, (CellBox{{-5, 0, 0}, {24, 8, 102}}));
  EXPECT_EQ(found.lowest, -2000);
  EXPECT_EQ(found.highest, 4000);
}

TEST(MapStatisticsTest, AnEmptyMapHasNothing) {
  const MapStatistics found = statistics_of(SparseMap({.voxel_m = 0.5}), kRule);
  EXPECT_EQ(found.bricks, 0U);
  EXPECT_EQ(found.known_cells, 0U);
  EXPECT_TRUE(found.known.empty());
  EXPECT_EQ(found.lowest, 0);
}

}  // namespace
}  // namespace skyhalo
