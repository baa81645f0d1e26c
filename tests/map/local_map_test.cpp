#include "skyhalo/map/local_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "map/local_map_flight.hpp"
#include "reference/naive_local_map.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kVoxelM = 0.25;

/// The reference map of METHOD 6: 8 x 8 x 5 m.
Eigen::Vector3i thesis_size() {
  return {32, 32, 20};
}

/// Calls `visit(cell)` for each cell of a box.
template <class Visit>
void for_each_cell(const CellBox& box, Visit&& visit) {
  for (int x = box.min.x(); x < box.max.x(); ++x) {
    for (int y = box.min.y(); y < box.max.y(); ++y) {
      for (int z = box.min.z(); z < box.max.z(); ++z) {
        visit(Eigen::Vector3i(x, y, z));
      }
    }
  }
}

/// Cells in which the two differ, of the map's and of a rim of `rim` cells about it.
int differing_cells(const LocalMap& map, const reference::NaiveLocalMap& naive, int rim) {
  int differing = 0;
  const Eigen::Vector3i out = Eigen::Vector3i::Constant(rim);
  for_each_cell({map.bounds().min - out, map.bounds().max + out}, [&](const Eigen::Vector3i& cell) {
    differing += map.at(cell) != naive.at(cell) ? 1 : 0;
  });
  return differing;
}

Eigen::Vector3i central_cell(const LocalMap& map) {
  return map.bounds().min + map.bounds().size() / 2;
}

TEST(LocalMapTest, TheThesissMapHas32By32By20Cells) {
  EXPECT_EQ(local_map_cells({8.0, 8.0, 5.0}, 0.25), thesis_size());
  EXPECT_EQ(local_map_cells({8.1, 7.9, 0.1}, 0.25), Eigen::Vector3i(33, 32, 1));
  // 40 KiB at 2 bytes a cell; whole bricks may be held.
  const std::size_t bytes = LocalMap(thesis_size(), kVoxelM).memory_bytes();
  EXPECT_GE(bytes, 32U * 32U * 20U * 2U);
  EXPECT_LE(bytes, 40U * 40U * 24U * 2U);
}

TEST(LocalMapTest, RefusesSidesAndVoxelsOutOfTheirDomain) {
  for (const double voxel_m : {0.0, -0.1, kNan}) {
    (void)message_of([&] { (void)local_map_cells({8.0, 8.0, 5.0}, voxel_m); });
    (void)message_of([&] { (void)LocalMap(thesis_size(), voxel_m); });
  }
  for (const double side_m : {0.0, -1.0, 4097.0, kNan, kInf}) {
    (void)message_of([&] { (void)local_map_cells({8.0, side_m, 5.0}, 1.0); });
  }
  for (const int side : {0, -1, 4097}) {
    (void)message_of([&] { (void)LocalMap({8, 8, side}, 1.0); });
  }
  EXPECT_NO_THROW((void)LocalMap({4096, 1, 1}, 1.0));
}

TEST(LocalMapTest, BeginsUnknownAboutTheOrigin) {
  const LocalMap map({5, 4, 3}, 0.5);
  EXPECT_EQ(map.bounds(), (CellBox{{-2, -2, -1}, {3, 2, 2}}));
  for_each_cell(map.bounds(), [&](const auto& cell) { EXPECT_EQ(map.at(cell), kUnknown); });
}

TEST(LocalMapTest, AStepForgetsOneLayerAndBringsAnUnknownOne) {
  LocalMap map({3, 3, 3}, 1.0);
  for_each_cell(map.bounds(), [&](const auto& cell) {
    map.set(cell, static_cast<LogOdds>(100 * cell.x() + 10 * cell.y() + cell.z()));
  });
  map.follow({1.5, 0.5, 0.5});
  EXPECT_EQ(map.bounds(), (CellBox{{0, -1, -1}, {3, 2, 2}}));
  EXPECT_EQ(map.at({-1, 0, 0}), kUnknown);
  EXPECT_EQ(map.at({0, 1, -1}), 9);
  EXPECT_EQ(map.at({1, -1, 1}), 91);
  EXPECT_EQ(map.at({2, 0, 0}), kUnknown);
}

TEST(LocalMapTest, WhatHasLeftIsForgottenEvenWhenItComesBack) {
  LocalMap map({4, 4, 4}, 1.0);
  map.set({-2, 0, 0}, 7);
  map.set({1, 0, 0}, 8);
  map.follow({1.0, 0.0, 0.0});
  map.follow({0.0, 0.0, 0.0});
  EXPECT_EQ(map.at({-2, 0, 0}), kUnknown);
  EXPECT_EQ(map.at({1, 0, 0}), 8);
}

TEST(LocalMapTest, WithinItsCellTheDroneMovesNothing) {
  LocalMap map({4, 4, 4}, 1.0);
  map.set({0, 0, 0}, 7);
  const CellBox before = map.bounds();
  map.follow({0.999, 0.5, 0.001});
  EXPECT_EQ(map.bounds(), before);
  EXPECT_EQ(map.at({0, 0, 0}), 7);
  map.follow({-0.001, 0.5, 0.001});
  EXPECT_EQ(map.bounds().min, before.min - Eigen::Vector3i::UnitX());
}

TEST(LocalMapTest, APositionThatIsNotFiniteMovesNothing) {
  LocalMap map({4, 4, 4}, 1.0);
  map.follow({10.0, 0.0, 0.0});
  map.set({10, 0, 0}, 7);
  const CellBox before = map.bounds();
  for (const double bad : {kNan, kInf, -kInf}) {
    map.follow({0.0, bad, 0.0});
    EXPECT_EQ(map.bounds(), before);
    EXPECT_EQ(map.at({10, 0, 0}), 7);
  }
}

TEST(LocalMapTest, AHugeJumpAndBackLeavesNothingKnown) {
  LocalMap map({5, 6, 7}, 0.1);
  map.set({0, 0, 0}, 7);
  map.follow({1e12, -1e12, 1e12});
  EXPECT_EQ(map.bounds().size(), Eigen::Vector3i(5, 6, 7));
  map.follow({0.0, 0.0, 0.0});
  for_each_cell(map.bounds(), [&](const auto& cell) { EXPECT_EQ(map.at(cell), kUnknown); });
}

TEST(LocalMapTest, ABrickIsCopiedAsTheCellsStand) {
  LocalMap map(thesis_size(), kVoxelM);
  map.follow({-3.1, 20.3, -0.6});
  std::mt19937 random(3);
  for_each_cell(map.bounds(),
                [&](const auto& cell) { map.set(cell, static_cast<LogOdds>(random() % 9999U)); });
  const CellBox bricks = bricks_touching(map.bounds());
  for_each_cell(bricks, [&](const Eigen::Vector3i& brick) {
    BrickCells cells{};
    map.copy_brick(brick, cells);
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      ASSERT_EQ(cells.cells[place], map.at(cell_in_brick(brick, place)));
    }
  });
}

TEST(LocalMapReference, AKilometreOfFlight) {
  LocalMap map(thesis_size(), kVoxelM);
  reference::NaiveLocalMap naive(thesis_size(), kVoxelM);
  std::mt19937 random(5);
  int shifts = 0;
  int far_jumps = 0;
  int known_once = 0;
  for (const Eigen::Vector3d& position_m : testing::winding_flight(1000.0, kVoxelM)) {
    const CellBox before = map.bounds();
    map.follow(position_m);
    naive.follow(position_m);
    ASSERT_EQ(map.bounds().min, naive.first());
    ASSERT_EQ(map.bounds().size(), thesis_size());
    ASSERT_EQ(central_cell(map), map.lattice().cell_of(position_m));
    shifts += map.bounds() == before ? 0 : 1;
    far_jumps += overlap(map.bounds(), before).empty() ? 1 : 0;
    ASSERT_EQ(differing_cells(map, naive, 2), 0) << "at " << position_m.transpose();
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3i place{static_cast<int>(random() % 32U),
                                  static_cast<int>(random() % 32U),
                                  static_cast<int>(random() % 20U)};
      const Eigen::Vector3i cell = map.bounds().min + place;
      known_once += map.at(cell) != kUnknown ? 1 : 0;
      const auto value = static_cast<LogOdds>(static_cast<int>(random() % 10001U) - 5000);
      map.set(cell, value);
      naive.set(cell, value);
    }
  }
  EXPECT_GT(shifts, 500);
  EXPECT_GT(far_jumps, 5);
  EXPECT_GT(known_once, 10000);  // the content lasts over shifts
}

TEST(LocalMapReference, OddAndFlatSizes) {
  for (const Eigen::Vector3i& size :
       {Eigen::Vector3i(7, 9, 3), Eigen::Vector3i(1, 1, 1), Eigen::Vector3i(40, 8, 1)}) {
    LocalMap map(size, 0.5);
    reference::NaiveLocalMap naive(size, 0.5);
    std::mt19937 random(11);
    for (const Eigen::Vector3d& position_m : testing::winding_flight(300.0, 0.5)) {
      map.follow(position_m);
      naive.follow(position_m);
      ASSERT_EQ(differing_cells(map, naive, 1), 0) << size.transpose();
      for_each_cell(map.bounds(), [&](const Eigen::Vector3i& cell) {
        const auto value = static_cast<LogOdds>(random() % 5000U);
        map.set(cell, value);
        naive.set(cell, value);
      });
    }
  }
}

}  // namespace
}  // namespace skyhalo
