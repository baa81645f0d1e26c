#include "skyhalo/map/nearest_occupied.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/random_maps.hpp"

namespace skyhalo {
namespace {

using reference::NaiveCell;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Cells of 0.5 m; the middle of cell (0, 0, 0) lies at 0.25 m.
SparseMap half_metre_map() {
  return SparseMap(VoxelLattice{Eigen::Vector3d::Zero(), 0.5});
}

const Eigen::Vector3d kMiddle(0.25, 0.25, 0.25);

TEST(NearestOccupiedTest, MeasuresToTheCube) {
  SparseMap map = half_metre_map();
  map.set({3, 0, 0}, 1);     // from x = 1.5 m on
  map.set({0, -20, 0}, 1);   // up to y = -9.5 m
  map.set({1, 1, 1}, -200);  // free
  const auto nearest = nearest_occupied(map, kMiddle, 5.0);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->cell, Eigen::Vector3i(3, 0, 0));
  EXPECT_NEAR(nearest->distance_m, 1.25, 1e-12);
}

TEST(NearestOccupiedTest, MeasuresSlantwise) {
  SparseMap map = half_metre_map();
  map.set({2, 3, -5}, 1);  // the near corner at (1, 1.5, -2): (0.75, 1.25, 2.25) away
  const auto nearest = nearest_occupied(map, kMiddle, 5.0);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance_m, std::sqrt(0.5625 + 1.5625 + 5.0625), 1e-12);
}

TEST(NearestOccupiedTest, LooksNoFartherThanTheRadius) {
  SparseMap map = half_metre_map();
  map.set({3, 0, 0}, 1);
  EXPECT_TRUE(nearest_occupied(map, kMiddle, 1.25));
  EXPECT_FALSE(nearest_occupied(map, kMiddle, 1.24));
  EXPECT_FALSE(nearest_occupied(map, kMiddle, -1.0));
  EXPECT_FALSE(nearest_occupied(map, kMiddle, kNan));
  EXPECT_FALSE(nearest_occupied(map, {0.0, kNan, 0.0}, 5.0));
  EXPECT_FALSE(nearest_occupied(map, {0.0, kInfinity, 0.0}, 5.0));
}

TEST(NearestOccupiedTest, IsZeroInsideAndAtAFace) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 0.0).value().distance_m, 0.0);
  EXPECT_EQ(nearest_occupied(map, {0.5, 0.25, 0.25}, 0.0).value().cell, Eigen::Vector3i(0, 0, 0));
  EXPECT_FALSE(nearest_occupied(map, {0.51, 0.25, 0.25}, 0.0));
}

TEST(NearestOccupiedTest, OfEquallyNearCellsTakesTheSmallest) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 9}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0).value().cell, Eigen::Vector3i(0, 0, 9));
  map.set({9, 0, 0}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0).value().cell, Eigen::Vector3i(0, 0, 9));
  map.set({0, 0, -9}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0).value().cell, Eigen::Vector3i(0, 0, -9));
  map.set({0, -9, 0}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0).value().cell, Eigen::Vector3i(0, -9, 0));
  map.set({-9, 0, 0}, 1);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0).value().cell, Eigen::Vector3i(-9, 0, 0));
}

TEST(NearestOccupiedTest, FollowsTheRule) {
  SparseMap map = half_metre_map();
  map.set({3, 0, 0}, 100);
  map.set({5, 0, 0}, 101);
  EXPECT_EQ(nearest_occupied(map, kMiddle, 9.0, {100, 0}).value().cell, Eigen::Vector3i(5, 0, 0));
}

TEST(NearestOccupiedTest, LooksAtBricksOfOneNumber) {
  SparseMap map = half_metre_map();
  map.set_uniform({2, 0, 0}, 700);  // from x = 8 m on
  const auto nearest = nearest_occupied(map, kMiddle, 9.0);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->cell, Eigen::Vector3i(16, 0, 0));
  EXPECT_NEAR(nearest->distance_m, 7.75, 1e-12);
}

TEST(NearestOccupiedTest, LooksFarOnAMapWithoutBounds) {
  SparseMap map = half_metre_map();
  EXPECT_FALSE(nearest_occupied(map, kMiddle, kInfinity));
  map.set({2000000, 0, 0}, 1);
  map.set({0, 5000000, -3000000}, 1);
  const auto nearest = nearest_occupied(map, kMiddle, kInfinity);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->cell, Eigen::Vector3i(2000000, 0, 0));
  EXPECT_NEAR(nearest->distance_m, 999999.75, 1e-6);
  EXPECT_EQ(nearest_occupied(map, {0.0, 3e9, 0.0}, kInfinity).value().cell,
            Eigen::Vector3i(0, 5000000, -3000000));
}

/// Goes through all cells; of equally near ones the first in order of x, y, z stays.
std::optional<NearCell> naive_nearest(const std::vector<NaiveCell>& cells,
                                      const Eigen::Vector3d& point_m,
                                      double radius_m) {
  std::optional<NearCell> nearest;
  for (const NaiveCell& cell : cells) {
    const double distance_m = naive_distance_m(cell, point_m);
    if (cell.known && cell.log_odds > 0 && distance_m <= radius_m &&
        (!nearest || distance_m < nearest->distance_m)) {
      nearest = NearCell{cell.index, distance_m};
    }
  }
  return nearest;
}

template <class Map>
void compare_nearest(const Map& map, unsigned seed) {
  const CellBox region = testing::known_and_rim(map);
  const std::vector<NaiveCell> cells = testing::cells_in(map, region);
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> radius_m(0.0, 8.0);
  int found = 0;
  const int count = 300;
  for (int i = 0; i < count; ++i) {
    const CellBox about{region.min.array() - 20, region.max.array() + 20};
    const Eigen::Vector3d point_m =
        testing::random_point(map.lattice(), i % 4 == 0 ? about : region, rng);
    const double limit_m = radius_m(rng);
    const auto nearest = nearest_occupied(map, point_m, limit_m);
    const auto expected = naive_nearest(cells, point_m, limit_m);
    ASSERT_EQ(nearest.has_value(), expected.has_value());
    if (nearest) {
      EXPECT_NEAR(nearest->distance_m, expected->distance_m, 1e-12);
      EXPECT_EQ(nearest->cell, expected->cell);
      ++found;
    }
  }
  EXPECT_GT(found, 30);
  EXPECT_LT(found, count - 10);
}

TEST(NearestOccupiedReference, IsTheNearestOfAllCells) {
  compare_nearest(testing::random_dense_map(0.003, 6), 6);
  compare_nearest(testing::random_local_map(0.003, 7), 7);
  compare_nearest(testing::random_sparse_map(0.003, 8), 8);
  compare_nearest(testing::random_dense_map(0.05, 9), 9);
}

}  // namespace
}  // namespace skyhalo
