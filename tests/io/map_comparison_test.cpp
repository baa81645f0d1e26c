#include "skyhalo/io/map_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/map_cases.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr OccupancyRule kRule{.occupied_above = 800, .free_below = 0};
constexpr std::size_t kNot = 0;
constexpr std::size_t kFree = 1;
constexpr std::size_t kOccupied = 2;

SparseMap map_at(double x_m) {
  return SparseMap({.origin_m = {x_m, 0.0, 0.0}, .voxel_m = 0.5});
}

TEST(MapComparisonTest, CellsAreCountedByWhatTheyAre) {
  SparseMap a = map_at(0.0);
  SparseMap b = map_at(0.0);
  // Cell, first, second.
  for (const auto& [x, first, second] : {std::tuple(0, 1000, 900),
                                         {1, 1000, -900},
                                         {2, -1000, 900},
                                         {3, -1000, -900},
                                         {4, 300, 900},  // seen, but of no clear opinion
                                         {5, 300, 500}}) {
    a.set({x, 0, 0}, static_cast<LogOdds>(first));
    b.set({x, 0, 0}, static_cast<LogOdds>(second));
  }
  a.set({6, 0, 0}, 1000);
  b.set({7, 0, 0}, -1000);
  const MapComparison found = compare_maps(a, b, kRule);
  EXPECT_EQ(found.cells[kOccupied][kOccupied], 1U);
  EXPECT_EQ(found.cells[kOccupied][kFree], 1U);
  EXPECT_EQ(found.cells[kFree][kOccupied], 1U);
  EXPECT_EQ(found.cells[kFree][kFree], 1U);
  EXPECT_EQ(found.cells[kNot][kOccupied], 1U);
  EXPECT_EQ(found.cells[kNot][kNot], 1U);
  EXPECT_EQ(found.cells[kOccupied][kNot], 1U);
  EXPECT_EQ(found.cells[kNot][kFree], 1U);
  EXPECT_EQ(found.cells[kFree][kNot], 0U);
  EXPECT_EQ(found.known_in_both, 6U);
  // Occupied in both: 1; in any: cells 0, 1, 2, 4, 6.
  EXPECT_DOUBLE_EQ(found.occupied_intersection_over_union.value(), 0.2);
  EXPECT_EQ(found.largest_difference->units, 1900);
  EXPECT_EQ(found.largest_difference->center_m, Eigen::Vector3d(0.75, 0.25, 0.25));
}

TEST(MapComparisonTest, CorrelationIsPearsons) {
  SparseMap a = map_at(0.0);
  SparseMap b = map_at(0.0);
  // x: 1, 2, 3; y: 1, 3, 2. Deviations -1, 0, 1 and -1, 1, 0: 1 / sqrt(2 * 2).
  a.set({0, 0, 0}, 1000);
  a.set({1, 0, 0}, 2000);
  a.set({2, 0, 0}, 3000);
  b.set({0, 0, 0}, 1000);
  b.set({1, 0, 0}, 3000);
  b.set({2, 0, 0}, 2000);
  b.set({3, 0, 0}, -5000);  // not known in both
  EXPECT_NEAR(compare_maps(a, b, kRule).correlation.value(), 0.5, 1e-12);
}

TEST(MapComparisonTest, UniformBricksCountAllTheirCells) {
  SparseMap a = map_at(0.0);
  a.set_uniform({0, 0, 0}, -1000);
  a.set_uniform({1, 0, 0}, 1000);
  a.set_uniform({2, 0, 0}, 1000);
  SparseMap b = map_at(0.0);
  b.set_uniform({0, 0, 0}, -3000);
  b.set_uniform({1, 0, 0}, 3000);
  b.set({16, 0, 0}, 3000);
  const MapComparison found = compare_maps(a, b, kRule);
  EXPECT_EQ(found.cells[kFree][kFree], 512U);
  EXPECT_EQ(found.cells[kOccupied][kOccupied], 513U);
  EXPECT_EQ(found.cells[kOccupied][kNot], 511U);
  EXPECT_EQ(found.known_in_both, 1025U);
  EXPECT_NEAR(found.correlation.value(), 1.0, 1e-12);
  EXPECT_EQ(found.largest_difference->units, 2000);
}

TEST(MapComparisonTest, OriginsWholeCellsApartAreCompared) {
  SparseMap a = map_at(0.0);
  a.set({4, 0, 0}, 1000);
  SparseMap b = map_at(1.5);
  b.set({1, 0, 0}, 900);
  const MapComparison found = compare_maps(a, b, kRule);
  EXPECT_EQ(found.cells[kOccupied][kOccupied], 1U);
  EXPECT_EQ(found.largest_difference->units, 100);
  EXPECT_EQ(found.largest_difference->center_m, Eigen::Vector3d(2.25, 0.25, 0.25));
}

TEST(MapComparisonTest, OtherCellsAreAnError) {
  EXPECT_THAT(message_of([] { (void)compare_maps(map_at(0.0), map_at(0.2), kRule); }),
              HasSubstr("whole cells"));
}

TEST(MapComparisonTest, EmptyMapsHaveNoNumbers) {
  const MapComparison found = compare_maps(map_at(0.0), map_at(0.0), kRule);
  EXPECT_EQ(found.known_in_both, 0U);
  EXPECT_FALSE(found.occupied_intersection_over_union);
  EXPECT_FALSE(found.correlation);
  EXPECT_FALSE(found.largest_difference);
}

TEST(MapComparisonTest, WhatDoesNotVaryHasNoCorrelation) {
  SparseMap a = map_at(0.0);
  a.set_uniform({0, 0, 0}, 1000);
  const MapComparison found = compare_maps(a, a, kRule);
  EXPECT_FALSE(found.correlation);
  EXPECT_EQ(found.occupied_intersection_over_union, 1.0);
  EXPECT_EQ(found.largest_difference->units, 0);
}

TEST(MapComparisonProperty, AMapIsLikeItself) {
  const SparseMap map = testing::random_map(4, 60, 3);
  const MapComparison found = compare_maps(map, map, kRule);
  EXPECT_NEAR(found.correlation.value(), 1.0, 1e-12);
  EXPECT_EQ(found.occupied_intersection_over_union, 1.0);
  EXPECT_EQ(found.largest_difference->units, 0);
  EXPECT_GT(found.known_in_both, 10000U);
}

TEST(MapComparisonProperty, ExchangedMapsGiveTheTableTransposed) {
  const SparseMap a = testing::random_map(4, 60, 2);
  const SparseMap b = testing::random_map(5, 60, 2);
  const MapComparison ab = compare_maps(a, b, kRule);
  const MapComparison ba = compare_maps(b, a, kRule);
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(ab.cells[i][j], ba.cells[j][i]);
      all += ab.cells[i][j];
    }
  }
  EXPECT_GT(all, 20000U);
  EXPECT_EQ(ab.correlation, ba.correlation);
  EXPECT_LT(std::abs(ab.correlation.value()), 0.2) << "they know nothing of each other";
}

}  // namespace
}  // namespace skyhalo
