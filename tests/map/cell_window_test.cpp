#include "skyhalo/map/cell_window.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "map/local_map_flight.hpp"
#include "map/random_scans.hpp"
#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"

namespace skyhalo {
namespace {

constexpr int kLimit = 5000;
constexpr double kVoxelM = 0.5;

/// All cells of a window, and when its bricks changed.
struct State {
  explicit State(const CellWindow& map) : bounds(map.bounds()), tick(map.tick()) {
    for_each_cell(bounds, [&](const Eigen::Vector3i& cell) {
      cells.push_back(map.at(cell));
      return true;
    });
    for_each_cell(bricks_touching(bounds), [&](const Eigen::Vector3i& brick) {
      stamps.push_back(map.changed_at(brick));
      return true;
    });
  }

  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const {
    return cells[place_in(bounds, cell)];
  }

  [[nodiscard]] std::uint64_t changed_at(const Eigen::Vector3i& brick) const {
    const CellBox bricks = bricks_touching(bounds);
    return bricks.holds(brick) ? stamps[place_in(bricks, brick)] : 0;
  }

  /// Whether a brick has a cell that differs from the map's, or is in one of the two alone.
  [[nodiscard]] bool differs(const CellWindow& map, const Eigen::Vector3i& brick) const {
    return !for_each_cell(cells_of(brick), [&](const Eigen::Vector3i& cell) {
      const bool was_in = bounds.holds(cell);
      return was_in == map.bounds().holds(cell) && (!was_in || at(cell) == map.at(cell));
    });
  }

  static std::size_t place_in(const CellBox& box, const Eigen::Vector3i& index) {
    const Eigen::Vector<std::size_t, 3> place = (index - box.min).cast<std::size_t>();
    const Eigen::Vector<std::size_t, 3> size = box.size().cast<std::size_t>();
    return (place.x() * size.y() + place.y()) * size.z() + place.z();
  }

  CellBox bounds;
  std::uint64_t tick;
  std::vector<LogOdds> cells;
  std::vector<std::uint64_t> stamps;
};

/// The bricks in which something has changed since have the tick of it, the others the old one.
/// Returns how many have changed.
int expect_stamps(const State& before, const CellWindow& map) {
  int changed = 0;
  for_each_cell(bricks_touching(map.bounds()), [&](const Eigen::Vector3i& brick) {
    if (before.differs(map, brick)) {
      ++changed;
      EXPECT_GT(map.changed_at(brick), before.tick) << "missed a change of " << brick.transpose();
      EXPECT_LE(map.changed_at(brick), map.tick()) << brick.transpose();
    } else {
      EXPECT_EQ(map.changed_at(brick), before.changed_at(brick))
          << "nothing has changed in " << brick.transpose();
    }
    return !::testing::Test::HasFailure();
  });
  return changed;
}

/// Both answer all questions alike.
void expect_same(const CellWindow& copy, const CellWindow& map) {
  ASSERT_EQ(copy.bounds(), map.bounds());
  ASSERT_EQ(copy.tick(), map.tick());
  const Eigen::Vector3i rim = Eigen::Vector3i::Ones();
  for_each_cell({map.bounds().min - rim, map.bounds().max + rim}, [&](const auto& cell) {
    EXPECT_EQ(copy.at(cell), map.at(cell)) << cell.transpose();
    return !::testing::Test::HasFailure();
  });
  for_each_cell(bricks_touching(map.bounds()), [&](const Eigen::Vector3i& brick) {
    EXPECT_EQ(copy.changed_at(brick), map.changed_at(brick)) << brick.transpose();
    return !::testing::Test::HasFailure();
  });
}

Eigen::Vector3i random_cell(const CellBox& box, std::mt19937& random) {
  return box.min + box.size().unaryExpr([&](int size) {
    return static_cast<int>(random() % static_cast<unsigned>(size));
  });
}

/// Few increments that are not 0, near the cells' limits.
BrickCells random_increments(std::mt19937& random) {
  BrickCells increments{};
  for (Increment& increment : increments.cells) {
    increment = random() % 64U != 0
                    ? Increment{0}
                    : static_cast<Increment>(static_cast<int>(random() % 10001U) - 5000);
  }
  return increments;
}

/// Scans, single cells and forgetting, in random order.
void change(CellWindow& map, std::mt19937& random) {
  const Eigen::Vector3i cell = random_cell(map.bounds(), random);
  switch (random() % 4U) {
    case 0:
      map.set(cell, map.at(cell) == 17 ? LogOdds{18} : LogOdds{17});
      break;
    case 1:
      map.begin_change();
      map.prepare(brick_of(cell), true);
      map.change_whole(brick_of(cell), random() % 2U == 0 ? 5000 : -5000, kLimit);
      break;
    default:
      map.begin_change();
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3i brick = brick_of(random_cell(map.bounds(), random));
        map.prepare(brick, false);
        map.change(brick, random_increments(random), kLimit);
      }
  }
}

/// A step of at most a few cells, or seldom a jump.
Eigen::Vector3d random_position(const LocalMap& map, std::mt19937& random) {
  const Eigen::Vector3i middle = map.bounds().min + map.bounds().size() / 2;
  const int reach = random() % 8U == 0 ? 40 : 2;
  const CellBox round{(middle.array() - reach).matrix(), (middle.array() + reach + 1).matrix()};
  return map.lattice().center_m(random_cell(round, random));
}

std::vector<LocalMap> local_maps() {
  std::vector<LocalMap> maps;
  for (const Eigen::Vector3i& size : {Eigen::Vector3i(20, 17, 9),
                                      Eigen::Vector3i(8, 8, 8),
                                      Eigen::Vector3i(1, 30, 2),
                                      Eigen::Vector3i(9, 10, 23)}) {
    maps.emplace_back(size, kVoxelM);
  }
  return maps;
}

DenseMap dense_map() {
  return DenseMap(VoxelGrid{{-3.0, 1.0, 0.5}, kVoxelM, {21, 10, 13}});
}

TEST(CellWindowTest, NothingHasChangedAtFirst) {
  const DenseMap map = dense_map();
  EXPECT_EQ(map.tick(), 0U);
  for_each_cell(bricks_touching(map.bounds()), [&](const Eigen::Vector3i& brick) {
    EXPECT_EQ(map.changed_at(brick), 0U);
    return true;
  });
  EXPECT_EQ(map.changed_at({-1, 0, 0}), 0U);
}

TEST(CellWindowTest, EachDecayIsATickOfItsOwn) {
  DenseMap map = dense_map();
  map.set({1, 1, 1}, 4000);
  DenseMap copy = map;
  const std::uint64_t before = map.tick();
  map.decay({.keep_occupied = 32768});
  EXPECT_GT(map.tick(), before);
  copy.catch_up(map);
  EXPECT_EQ(copy.at({1, 1, 1}), 2000);
}

TEST(CellWindowTest, DecayChangesNoBrickOfWhichNothingIsKnown) {
  DenseMap map = dense_map();
  map.set({1, 1, 1}, 4000);
  map.begin_change();
  map.decay({.keep_occupied = 32768});
  EXPECT_EQ(map.at({1, 1, 1}), 2000);
  EXPECT_EQ(map.changed_at({0, 0, 0}), map.tick());
  EXPECT_EQ(map.changed_at({1, 0, 0}), 0U);
}

TEST(CellWindowTest, DecayForgetsInAllCells) {
  LocalMap map({5, 6, 7}, kVoxelM);
  map.follow({100.0, -3.0, 7.0});
  std::mt19937 random(2);
  for_each_cell(map.bounds(), [&](const Eigen::Vector3i& cell) {
    map.set(cell, static_cast<LogOdds>(static_cast<int>(random() % 65535U) - 32767));
    return true;
  });
  const DecayStep step{.keep_occupied = 30000, .keep_free = 60000, .unknown_below = 900};
  const State before(map);
  map.decay(step);
  for_each_cell(map.bounds(), [&](const Eigen::Vector3i& cell) {
    EXPECT_EQ(map.at(cell), decayed(before.at(cell), step));
    return true;
  });
}

TEST(CellWindowTest, IncrementsBeyondTheBoundsAreLeftOut) {
  DenseMap map = dense_map();  // 10 cells along y: 2 of the second brick
  map.begin_change();
  map.prepare({0, 1, 0}, true);
  map.change_whole({0, 1, 0}, 300, kLimit);
  map.change_whole({0, 2, 0}, 300, kLimit);
  map.change_whole({0, -1, 0}, 300, kLimit);
  EXPECT_EQ(map.at({0, 9, 0}), 300);
  EXPECT_EQ(map.at({0, 10, 0}), kUnknown);
  int known = 0;
  for_each_known_cell(map, map.bounds(), [&](const auto&, LogOdds) { ++known; });
  EXPECT_EQ(known, 8 * 2 * 8);
  EXPECT_EQ(map.changed_at({0, 2, 0}), 0U);
}

TEST(CellWindowProperty, ABricksTickMovesWithItsChangesAlone) {
  std::mt19937 random(31);
  DenseMap map = dense_map();
  int changed = 0;
  for (int i = 0; i < 2000; ++i) {
    const State before(map);
    change(map, random);
    changed += expect_stamps(before, map);
    ASSERT_FALSE(HasFailure()) << "after change " << i;
  }
  EXPECT_GT(changed, 1000);
}

TEST(CellWindowProperty, AndWithCellsThatEnterOrLeave) {
  for (LocalMap& map : local_maps()) {
    std::mt19937 random(32);
    int changed = 0;
    for (int i = 0; i < 1000; ++i) {
      const State before(map);
      if (random() % 2U == 0) {
        map.follow(random_position(map, random));
      } else {
        change(map, random);
      }
      changed += expect_stamps(before, map);
      ASSERT_FALSE(HasFailure()) << "after change " << i << " of a map of "
                                 << map.bounds().size().transpose();
    }
    EXPECT_GT(changed, 1000);
  }
}

TEST(CellWindowProperty, EveryBrickThatADecayChangesIsMarked) {
  std::mt19937 random(33);
  LocalMap map({20, 17, 9}, kVoxelM);
  for (int i = 0; i < 200; ++i) {
    change(map, random);
    map.follow(random_position(map, random));
    const State before(map);
    map.begin_change();
    map.decay({.keep_occupied = 60000, .keep_free = 50000, .unknown_below = 300});
    for_each_cell(bricks_touching(map.bounds()), [&](const Eigen::Vector3i& brick) {
      EXPECT_TRUE(map.changed_at(brick) > before.tick || !before.differs(map, brick));
      return true;
    });
  }
}

TEST(CellWindowProperty, ACopyOfALocalMapCatchesUp) {
  for (LocalMap& map : local_maps()) {
    std::mt19937 random(34);
    LocalMap often = map;
    LocalMap seldom = map;
    for (int i = 0; i < 1500; ++i) {
      switch (random() % 16U) {
        case 0:
          map.begin_change();
          map.decay({.keep_occupied = 60000, .keep_free = 50000, .unknown_below = 300});
          break;
        case 1:
        case 2:
        case 3:
        case 4:
          map.follow(random_position(map, random));
          break;
        default:
          change(map, random);
      }
      often.catch_up(map);
      expect_same(often, map);
      if (i % 31 == 0) {
        seldom.catch_up(map);
        expect_same(seldom, map);
      }
      ASSERT_FALSE(HasFailure()) << "after change " << i << " of a map of "
                                 << map.bounds().size().transpose();
    }
  }
}

TEST(CellWindowProperty, ACopyCatchesUpOverAFlightWithScans) {
  LocalMap map({32, 32, 20}, 0.25);
  LocalMap copy = map;
  ScanIntegrator integrator(IntegrationConfig{});
  testing::Random random(35);
  const std::vector<Eigen::Vector3d> flight = testing::winding_flight(300.0, 0.25);
  for (std::size_t i = 0; i < flight.size(); i += 3) {
    map.follow(flight[i]);
    const State before(map);
    const Pose T_map_body = make_pose(testing::any_attitude(random), flight[i]);
    (void)integrator.integrate(testing::noise_scan(random, 18, 4.0), T_map_body, map);
    ASSERT_GT(expect_stamps(before, map), 0);
    copy.catch_up(map);
    expect_same(copy, map);
    ASSERT_FALSE(HasFailure()) << "at " << flight[i].transpose();
  }
}

}  // namespace
}  // namespace skyhalo
