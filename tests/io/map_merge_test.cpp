#include "skyhalo/io/map_merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/map_cases.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::difference;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;

SparseMap map_at(double x_m) {
  return SparseMap({.origin_m = {x_m, 0.0, 0.0}, .voxel_m = 0.5});
}

TEST(MapMergeTest, LogOddsAdd) {
  SparseMap a = map_at(0.0);
  a.set({0, 0, 0}, 1000);
  a.set({1, 0, 0}, -300);
  SparseMap b = map_at(0.0);
  b.set({0, 0, 0}, 500);
  b.set({2, 0, 0}, 0);
  add_log_odds(a, b);
  EXPECT_EQ(a.at({0, 0, 0}), 1500);
  EXPECT_EQ(a.at({1, 0, 0}), -300);
  EXPECT_EQ(a.at({2, 0, 0}), 0) << "known, of no opinion";
  EXPECT_EQ(a.at({3, 0, 0}), kUnknown);
}

TEST(MapMergeTest, UniformBricksAddToAllKinds) {
  SparseMap a = map_at(0.0);
  a.set_uniform({0, 0, 0}, -1000);
  a.set({8, 0, 0}, 50);
  SparseMap b = map_at(0.0);
  b.set_uniform({0, 0, 0}, -500);
  b.set_uniform({1, 0, 0}, -500);
  b.set_uniform({2, 0, 0}, -500);
  add_log_odds(a, b);
  EXPECT_EQ(a.uniform({0, 0, 0}), LogOdds{-1500});
  EXPECT_EQ(a.at({8, 0, 0}), -450);
  EXPECT_EQ(a.at({9, 0, 0}), -500);
  EXPECT_EQ(a.uniform({2, 0, 0}), LogOdds{-500});
}

TEST(MapMergeTest, OriginsWholeCellsApartAreMerged) {
  SparseMap a = map_at(0.0);
  a.set({4, 0, 0}, 1000);
  SparseMap b = map_at(1.5);  // its cell 1 is the other's 4
  b.set({1, 0, 0}, 200);
  b.set_uniform({1, 1, 1}, -70);
  add_log_odds(a, b);
  EXPECT_EQ(a.at({4, 0, 0}), 1200);
  EXPECT_EQ(a.at({10, 8, 8}), kUnknown);
  EXPECT_EQ(a.at({11, 8, 8}), -70);
  EXPECT_EQ(a.at({18, 15, 15}), -70);
  EXPECT_EQ(a.at({19, 15, 15}), kUnknown);
}

TEST(MapMergeTest, SumsStayWithinACell) {
  SparseMap a = map_at(0.0);
  a.set({0, 0, 0}, 32000);
  a.set({1, 0, 0}, -32000);
  SparseMap b = a;
  add_log_odds(a, b);
  EXPECT_EQ(a.at({0, 0, 0}), 32767);
  EXPECT_EQ(a.at({1, 0, 0}), -32767);
}

TEST(MapMergeTest, OtherCellsAreAnError) {
  SparseMap a = map_at(0.0);
  EXPECT_THAT(message_of([&] { add_log_odds(a, map_at(0.25)); }), HasSubstr("whole cells"));
}

TEST(MapMergeTest, TheLimitHoldsForAllCells) {
  SparseMap map = map_at(0.0);
  map.set({0, 0, 0}, 700);
  map.set({1, 0, 0}, -700);
  map.set({2, 0, 0}, 499);
  map.set_uniform({3, 0, 0}, -32767);
  limit_log_odds(map, 500);
  EXPECT_EQ(map.at({0, 0, 0}), 500);
  EXPECT_EQ(map.at({1, 0, 0}), -500);
  EXPECT_EQ(map.at({2, 0, 0}), 499);
  EXPECT_EQ(map.at({3, 0, 0}), kUnknown);
  EXPECT_EQ(map.uniform({3, 0, 0}), LogOdds{-500});
}

TEST(MapMergeProperty, TheOrderDoesNotMatter) {
  // Small enough that no sum leaves what a cell can hold.
  SparseMap a = testing::random_map(1, 40, 2);
  SparseMap b = testing::random_map(2, 40, 2);
  SparseMap c = testing::random_map(3, 40, 2);
  for (SparseMap* const map : {&a, &b, &c}) {
    limit_log_odds(*map, 10000);
  }
  SparseMap forwards = a;
  add_log_odds(forwards, b);
  add_log_odds(forwards, c);
  SparseMap backwards = c;
  add_log_odds(backwards, b);
  add_log_odds(backwards, a);
  limit_log_odds(forwards, 5000);
  limit_log_odds(backwards, 5000);
  EXPECT_GT(forwards.brick_count(), 60U);
  EXPECT_THAT(difference(forwards, backwards), IsEmpty());
}

}  // namespace
}  // namespace skyhalo
