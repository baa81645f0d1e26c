#include "skyhalo/map/ray_cast.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/random_maps.hpp"

namespace skyhalo {
namespace {

using reference::NaiveCell;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 8 x 2 x 2 cells of 0.5 m from the origin: free up to x = 2, unknown up to 3, a wall from 3 on.
DenseMap row_of_cells() {
  DenseMap map(VoxelGrid{Eigen::Vector3d::Zero(), 0.5, {8, 2, 2}});
  for_each_cell(map.bounds(), [&map](const Eigen::Vector3i& cell) {
    if (cell.x() < 4 || cell.x() >= 6) {
      map.set(cell, cell.x() < 4 ? LogOdds{-300} : LogOdds{300});
    }
    return true;
  });
  return map;
}

const Ray kForward{{0.25, 0.25, 0.25}, {1.0, 0.0, 0.0}};

TEST(RayCastTest, FindsTheFirstOccupiedCell) {
  const auto hit = ray_cast(row_of_cells(), kForward, 10.0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->cell, Eigen::Vector3i(6, 0, 0));
  EXPECT_NEAR(hit->range_m, 2.75, 1e-12);
  EXPECT_EQ(hit->occupancy, Occupancy::kOccupied);
}

TEST(RayCastTest, EndsAtItsRange) {
  EXPECT_FALSE(ray_cast(row_of_cells(), kForward, 2.7));
  EXPECT_TRUE(ray_cast(row_of_cells(), kForward, 2.8));
  EXPECT_FALSE(ray_cast(row_of_cells(), kForward, kNan));
  EXPECT_FALSE(ray_cast(row_of_cells(), kForward, 0.0));
}

TEST(RayCastTest, StopsAtWhatIsUnknown) {
  const auto hit = ray_cast(row_of_cells(), kForward, 10.0, {}, true);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->cell, Eigen::Vector3i(4, 0, 0));
  EXPECT_NEAR(hit->range_m, 1.75, 1e-12);
  EXPECT_EQ(hit->occupancy, Occupancy::kNotKnown);
}

TEST(RayCastTest, StopsBeyondTheBounds) {
  const auto hit = ray_cast(row_of_cells(), {kForward.origin_m, {-1.0, 0.0, 0.0}}, 10.0, {}, true);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->cell, Eigen::Vector3i(-1, 0, 0));
  EXPECT_NEAR(hit->range_m, 0.25, 1e-12);
}

TEST(RayCastTest, ComesFromOutside) {
  const Ray from_afar{{-1e5, 0.25, 0.25}, {1.0, 0.0, 0.0}};
  const auto hit = ray_cast(row_of_cells(), from_afar, kInfinity);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->cell, Eigen::Vector3i(6, 0, 0));
  EXPECT_NEAR(hit->range_m, 100003.0, 1e-6);
  EXPECT_EQ(ray_cast(row_of_cells(), from_afar, kInfinity, {}, true).value().range_m, 0.0);
}

TEST(RayCastTest, HitsTheCellThatItStartsIn) {
  const auto hit = ray_cast(row_of_cells(), {{3.6, 0.25, 0.25}, {-1.0, 0.0, 0.0}}, 10.0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->cell, Eigen::Vector3i(7, 0, 0));
  EXPECT_EQ(hit->range_m, 0.0);
}

TEST(RayCastTest, FollowsTheRule) {
  EXPECT_FALSE(ray_cast(row_of_cells(), kForward, 10.0, {300, 0}));
  EXPECT_EQ(ray_cast(row_of_cells(), kForward, 10.0, {0, -300}, true).value().range_m, 0.0);
}

TEST(RayCastTest, GoesNowhereWithoutADirection) {
  EXPECT_FALSE(ray_cast(row_of_cells(), {kForward.origin_m, Eigen::Vector3d::Zero()}, 10.0));
  EXPECT_FALSE(ray_cast(row_of_cells(), {kForward.origin_m, {kNan, 0.0, 0.0}}, 10.0));
  EXPECT_FALSE(ray_cast(row_of_cells(), {{0.2, kNan, 0.2}, {1.0, 0.0, 0.0}}, 10.0));
}

TEST(RayCastTest, ComesToAnEndOnAMapWithoutBounds) {
  SparseMap map(VoxelLattice{Eigen::Vector3d::Zero(), 0.1});
  EXPECT_FALSE(ray_cast(map, kForward, kInfinity));
  map.set({500, 2, 2}, 300);
  const auto hit = ray_cast(map, kForward, kInfinity);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 49.75, 1e-9);
  EXPECT_FALSE(ray_cast(map, {kForward.origin_m, {-1.0, 0.0, 0.0}}, kInfinity));
}

/// The nearest cell that stops the ray, of all cells.
std::optional<RayHit> naive_hit(const std::vector<NaiveCell>& cells,
                                const Ray& ray,
                                double max_m,
                                bool unknown_stops) {
  std::optional<RayHit> hit;
  for (const NaiveCell& cell : cells) {
    const auto answer = naive_answer(cell, 100, -100);
    const auto part = naive_stretch(cell, ray.origin_m, ray.direction);
    if (answer == reference::NaiveAnswer::kFree || !part || part->leave <= 1e-12 ||
        (answer == reference::NaiveAnswer::kNotKnown && !unknown_stops)) {
      continue;
    }
    const double range_m = std::max(0.0, part->enter);
    if (range_m < max_m && (!hit || range_m < hit->range_m)) {
      hit = RayHit{cell.index,
                   range_m,
                   answer == reference::NaiveAnswer::kOccupied ? Occupancy::kOccupied
                                                               : Occupancy::kNotKnown};
    }
  }
  return hit;
}

template <class Map>
void compare_rays(const Map& map, unsigned seed) {
  const CellBox region = testing::known_and_rim(map);
  const std::vector<NaiveCell> cells = testing::cells_in(map, region);
  std::mt19937 rng(seed);
  int hits = 0;
  int unknown = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d origin_m = testing::random_point(map.lattice(), region, rng);
    const Eigen::Vector3d to_m = testing::random_point(map.lattice(), region, rng);
    const Ray ray{origin_m, (to_m - origin_m).normalized()};
    const double max_m = 1.2 * (to_m - origin_m).norm();
    const bool unknown_stops = i % 3 == 0;
    const auto hit = ray_cast(map, ray, max_m, {100, -100}, unknown_stops);
    const auto expected = naive_hit(cells, ray, max_m, unknown_stops);
    ASSERT_EQ(hit.has_value(), expected.has_value());
    if (hit) {
      EXPECT_EQ(hit->cell, expected->cell);
      EXPECT_NEAR(hit->range_m, expected->range_m, 1e-9);
      EXPECT_EQ(hit->occupancy, expected->occupancy);
      hits += hit->occupancy == Occupancy::kOccupied ? 1 : 0;
      unknown += hit->occupancy == Occupancy::kOccupied ? 0 : 1;
    }
  }
  EXPECT_GT(hits, 30);
  EXPECT_GT(unknown, 10);
}

TEST(RayCastReference, IsTheNearestOfAllCells) {
  compare_rays(testing::random_dense_map(0.05, 3), 3);
  compare_rays(testing::random_local_map(0.05, 4), 4);
  compare_rays(testing::random_sparse_map(0.05, 5), 5);
}

}  // namespace
}  // namespace skyhalo
