#include "skyhalo/map/sparse_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "map/sparse_map_changes.hpp"
#include "skyhalo/geometry/lattice_walk.hpp"

namespace skyhalo {
namespace {

using testing::change_both;
using testing::empty_map;
using testing::kLimit;
using testing::MapOfCells;
using testing::Place;
using testing::place_of;

/// Both have the same known cells, whichever way they are asked.
void expect_same(const SparseMap& map, const MapOfCells& naive) {
  std::size_t known = 0;
  BrickCells cells{};
  for (const Eigen::Vector3i& brick : map.bricks()) {
    ASSERT_TRUE(map.holds_brick(brick));
    map.copy_brick(brick, cells);
    const std::optional<LogOdds> uniform = map.uniform(brick);
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      const Eigen::Vector3i cell = cell_in_brick(brick, place);
      ASSERT_EQ(cells.cells[place], naive.at(cell)) << cell.transpose();
      ASSERT_EQ(map.at(cell), naive.at(cell)) << cell.transpose();
      ASSERT_EQ(uniform.value_or(cells.cells[place]), cells.cells[place]);
      known += cells.cells[place] != kUnknown ? 1U : 0U;
    }
  }
  ASSERT_EQ(known, naive.cells().size()) << "a known cell is in no brick";
}

TEST(SparseMapTest, BeginsUnknown) {
  const SparseMap map = empty_map();
  EXPECT_EQ(map.at({0, 0, 0}), kUnknown);
  EXPECT_EQ(map.brick_count(), 0U);
  EXPECT_TRUE(map.bricks().empty());
  EXPECT_TRUE(map.known_bounds().empty());
  EXPECT_EQ(map.bounds(), whole_lattice());
  EXPECT_EQ(map.uniform({0, 0, 0}), kUnknown);
  EXPECT_EQ(map.tick(), 0U);
  EXPECT_EQ(map.changed_at({0, 0, 0}), 0U);
  EXPECT_EQ(map.held_bytes(), 0U);
}

TEST(SparseMapTest, CellsOnBothSidesOfTheOriginAndAtTheEnds) {
  SparseMap map = empty_map();
  const int far = VoxelLattice::kReach;
  const std::vector<Eigen::Vector3i> cells{
      {0, 0, 0}, {-1, 0, 0}, {-8, -9, 7}, {far - 1, -far, 0}, {-far, far - 1, far - 1}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    map.set(cells[i], static_cast<LogOdds>(i + 1));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(map.at(cells[i]), static_cast<LogOdds>(i + 1));
  }
  EXPECT_EQ(map.brick_count(), cells.size());
  EXPECT_EQ(map.at({1, 0, 0}), kUnknown);
}

TEST(SparseMapTest, BricksAreSortedByTheirPlace) {
  SparseMap map = empty_map();
  for (const Eigen::Vector3i& brick : {Eigen::Vector3i(2, 0, 0),
                                       Eigen::Vector3i(-2, 5, 0),
                                       Eigen::Vector3i(-2, 5, -1),
                                       Eigen::Vector3i(-2, -5, 9)}) {
    map.set_uniform(brick, 5);
  }
  EXPECT_EQ(map.bricks(),
            (std::vector<Eigen::Vector3i>{{-2, -5, 9}, {-2, 5, -1}, {-2, 5, 0}, {2, 0, 0}}));
  EXPECT_EQ(map.known_bounds(), (CellBox{{-16, -40, -8}, {24, 48, 80}}));
}

TEST(SparseMapTest, EqualCellsAreStoredAsOneNumber) {
  SparseMap map = empty_map();
  BrickCells cells{};
  cells.cells.fill(-700);
  map.set_brick({1, 2, 3}, cells);
  EXPECT_EQ(map.uniform({1, 2, 3}), -700);
  const std::size_t bytes = map.held_bytes();
  EXPECT_LT(bytes, 128U);
  cells.cells[17] = 3;
  map.set_brick({1, 2, 3}, cells);
  EXPECT_EQ(map.uniform({1, 2, 3}), std::nullopt);
  EXPECT_GE(map.held_bytes(), bytes + sizeof(BrickCells));
  cells.cells.fill(kUnknown);
  map.set_brick({1, 2, 3}, cells);
  EXPECT_FALSE(map.holds_brick({1, 2, 3}));
  EXPECT_EQ(map.held_bytes(), 0U);
}

TEST(SparseMapTest, AWholeChangeOfASeenFreeBrickStaysOneNumber) {
  SparseMap map = empty_map();
  map.begin_change();
  map.prepare({0, 0, 0}, true);
  map.change_whole({0, 0, 0}, -847, kLimit);
  EXPECT_EQ(map.uniform({0, 0, 0}), -847);
  EXPECT_EQ(map.changed_at({0, 0, 0}), map.tick());
  map.begin_change();
  map.change_whole({0, 0, 0}, -5000, kLimit);
  EXPECT_EQ(map.uniform({0, 0, 0}), -kLimit);
  const std::uint64_t changed_at = map.changed_at({0, 0, 0});
  map.begin_change();
  map.change_whole({0, 0, 0}, -847, kLimit);
  EXPECT_EQ(map.changed_at({0, 0, 0}), changed_at) << "at the limit nothing changes";
}

TEST(SparseMapTest, AChangeOfNothingLeavesCellsUnknown) {
  SparseMap map = empty_map();
  map.begin_change();
  map.prepare({0, 0, 0}, true);
  map.change_whole({0, 0, 0}, 0, kLimit);
  map.prepare({1, 0, 0}, false);
  BrickCells nothing{};
  nothing.cells.fill(0);
  map.change({1, 0, 0}, nothing, kLimit);
  EXPECT_EQ(map.at({0, 0, 0}), kUnknown);
  EXPECT_EQ(map.at({8, 0, 0}), kUnknown);
}

TEST(SparseMapTest, DecayForgetsBricksOfWhichNothingIsKnown) {
  SparseMap map = empty_map();
  map.set_uniform({0, 0, 0}, 60);
  map.set_uniform({5, 0, 0}, -5000);
  map.set({-1, 0, 0}, 60);
  map.begin_change();
  const std::uint64_t before = map.tick();
  map.decay({.keep_occupied = 50000, .keep_free = 50000});
  EXPECT_EQ(map.bricks(), (std::vector<Eigen::Vector3i>{{5, 0, 0}}));
  EXPECT_EQ(map.at({40, 0, 0}), -3814);  // 5000 * 50000 / 65536 = 3814.7
  EXPECT_GE(map.forgot_at(), before);
  EXPECT_GE(map.changed_at({5, 0, 0}), before);
}

TEST(SparseMapTest, EachDecayIsATickOfItsOwn) {
  SparseMap map = empty_map();
  map.set_uniform({0, 0, 0}, 4000);
  SparseMap copy = map;
  const std::uint64_t before = map.tick();
  map.decay({.keep_occupied = 32768});
  EXPECT_GT(map.tick(), before);
  copy.catch_up(map);
  EXPECT_EQ(copy.at({0, 0, 0}), 2000);
}

TEST(SparseMapTest, MemoryOfForgottenBricksIsUsedAgain) {
  SparseMap map = empty_map();
  const auto fill = [&](int from) {
    for (int i = 0; i < 1000; ++i) {
      map.set({8 * (from + i), 0, 0}, 5);
    }
  };
  fill(0);
  const std::size_t taken = map.memory_bytes();
  const std::size_t held = map.held_bytes();
  EXPECT_GE(taken, held);
  EXPECT_GE(held, 1000 * sizeof(BrickCells));
  for (int round = 1; round <= 20; ++round) {
    for (const Eigen::Vector3i& brick : map.bricks()) {
      map.erase_brick(brick);
    }
    EXPECT_EQ(map.held_bytes(), 0U);
    fill(1000 * round);
    EXPECT_EQ(map.held_bytes(), held);
  }
  // The list of unused cells alone may have grown.
  EXPECT_LT(map.memory_bytes(), taken + taken / 100);
}

TEST(SparseMapTest, ClearForgetsEverything) {
  SparseMap map = empty_map();
  std::mt19937 random(4);
  MapOfCells naive;
  for (int i = 0; i < 50; ++i) {
    change_both(map, naive, random);
  }
  SparseMap copy = map;
  map.clear();
  expect_same(map, {});
  EXPECT_EQ(map.held_bytes(), 0U);
  copy.catch_up(map);
  expect_same(copy, {});
  map.set({1, 2, 3}, 7);
  EXPECT_EQ(map.at({1, 2, 3}), 7);
}

TEST(SparseMapProperty, AgreesWithAMapOfSingleCells) {
  std::mt19937 random(11);
  SparseMap map = empty_map();
  MapOfCells naive;
  std::uint64_t tick = map.tick();
  for (int i = 0; i < 3000; ++i) {
    change_both(map, naive, random);
    ASSERT_GE(map.tick(), tick);
    tick = map.tick();
    if (i % 20 == 0) {
      expect_same(map, naive);
      ASSERT_FALSE(HasFatalFailure()) << "after change " << i;
      ASSERT_GE(map.memory_bytes(), map.held_bytes());
    }
  }
  EXPECT_GT(naive.cells().size(), 1000U);
}

TEST(SparseMapProperty, ManyBricksAreFoundWhateverGoes) {
  std::mt19937 random(12);
  SparseMap map = empty_map();
  std::set<Place> held;
  for (int i = 0; i < 60000; ++i) {
    const Eigen::Vector3i brick(static_cast<int>(random() % 40U) - 20,
                                static_cast<int>(random() % 40U) - 20,
                                static_cast<int>(random() % 4U));
    if (random() % 3U != 0) {
      map.set_uniform(brick, static_cast<LogOdds>(1 + brick.x() * brick.y()));
      held.insert(place_of(brick));
    } else {
      map.erase_brick(brick);
      held.erase(place_of(brick));
    }
  }
  EXPECT_EQ(map.brick_count(), held.size());
  EXPECT_GT(held.size(), 3000U);
  for_each_cell({{-21, -21, -1}, {21, 21, 5}}, [&](const Eigen::Vector3i& brick) {
    EXPECT_EQ(map.holds_brick(brick), held.contains(place_of(brick))) << brick.transpose();
    EXPECT_EQ(map.at(first_cell(brick)),
              held.contains(place_of(brick)) ? 1 + brick.x() * brick.y() : kUnknown);
    return !HasFailure();
  });
}

TEST(SparseMapProperty, CopiesAreIndependent) {
  std::mt19937 random(13);
  SparseMap map = empty_map();
  MapOfCells naive;
  for (int round = 0; round < 40; ++round) {
    for (int i = 0; i < 10; ++i) {
      change_both(map, naive, random);
    }
    SparseMap copy = map;
    SparseMap assigned = empty_map();
    assigned.set({0, 0, 0}, 1);
    assigned = map;
    ASSERT_TRUE(copy.lattice() == map.lattice());
    MapOfCells naive_copy = naive;
    for (int i = 0; i < 10; ++i) {
      change_both(copy, naive_copy, random);
    }
    expect_same(map, naive);
    expect_same(assigned, naive);
    expect_same(copy, naive_copy);
    const SparseMap moved = std::move(copy);
    expect_same(moved, naive_copy);
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
  }
}

TEST(SparseMapProperty, ACopyCatchesUp) {
  std::mt19937 random(14);
  SparseMap map = empty_map();
  MapOfCells naive;
  SparseMap often = map;
  SparseMap seldom = map;
  int forgot = 0;
  for (int i = 0; i < 1200; ++i) {
    const std::uint64_t forgot_at = map.forgot_at();
    change_both(map, naive, random);
    forgot += map.forgot_at() > forgot_at ? 1 : 0;
    often.catch_up(map);
    ASSERT_EQ(often.tick(), map.tick());
    if (i % 5 == 0) {
      expect_same(often, naive);
    }
    if (i % 37 == 0) {
      seldom.catch_up(map);
      expect_same(seldom, naive);
      for (const Eigen::Vector3i& brick : map.bricks()) {
        ASSERT_EQ(seldom.changed_at(brick), map.changed_at(brick));
      }
    }
    ASSERT_FALSE(HasFatalFailure()) << "after change " << i;
  }
  EXPECT_GT(forgot, 50);
}

TEST(SparseMapProperty, EveryChangedBrickHasTheTickOfItsChange) {
  std::mt19937 random(15);
  SparseMap map = empty_map();
  MapOfCells naive;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t since = map.tick();
    const MapOfCells before = naive;
    change_both(map, naive, random);
    for (const auto& [place, value] : naive.cells()) {
      const Eigen::Vector3i cell(place[0], place[1], place[2]);
      if (before.at(cell) != value) {
        ASSERT_GT(map.changed_at(brick_of(cell)), since) << "after change " << i;
      }
    }
    for (const auto& [place, value] : before.cells()) {
      const Eigen::Vector3i cell(place[0], place[1], place[2]);
      if (naive.at(cell) == kUnknown) {
        ASSERT_GT(std::max(map.changed_at(brick_of(cell)), map.forgot_at()), since);
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo
