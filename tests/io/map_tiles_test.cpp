#include "skyhalo/io/map_tiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "io/map_cases.hpp"
#include "io/map_tiles_cases.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::difference;
using ::testing::HasSubstr;
using testing::message_of;
using testing::no_budget;
using testing::TempFolder;
using testing::tiles_lattice;
using testing::Wanderer;

constexpr int kTileCells = 64;
constexpr double kTileM = 16.0;
constexpr double kReachM = 10.0;

MapTilesConfig large_budget() {
  return {.reach_m = kReachM, .limit_units = Wanderer::kLimit};
}

Eigen::Vector3i tile_place(const Eigen::Vector3i& brick) {
  return brick.unaryExpr([](int i) { return i >> 3; });
}

/// Distance (m) from a point to a tile's box.
double distance_m(const Eigen::Vector3d& point_m, const Eigen::Vector3i& tile) {
  const Eigen::Vector3d min_m = tiles_lattice().origin_m + kTileM * tile.cast<double>();
  const Eigen::Array3d below = (min_m - point_m).array();
  const Eigen::Array3d above = (point_m - min_m).array() - kTileM;
  return below.max(above).max(0.0).matrix().norm();
}

SparseMap empty_map() {
  return SparseMap(tiles_lattice());
}

/// The middle of tile (x, 0, 0), in m.
Eigen::Vector3d middle_m(int x) {
  return tiles_lattice().origin_m + kTileM * Eigen::Vector3d(x + 0.5, 0.5, 0.5);
}

/// A cell of tile (x, 0, 0), and others of the same brick.
Eigen::Vector3i cell_of_tile(int x) {
  return {x * kTileCells + 5, 6, 7};
}

/// A scan's increment of one cell.
void add(SparseMap& map, const Eigen::Vector3i& cell, Increment increment) {
  BrickCells increments{};
  increments.cells[place_in_brick(cell)] = increment;
  map.begin_change();
  map.prepare(brick_of(cell), false);
  map.change(brick_of(cell), increments, Wanderer::kLimit);
}

class MapTilesTest : public ::testing::Test {
 protected:
  /// All that the folder holds.
  [[nodiscard]] SparseMap saved() const { return read_tiles(folder).map; }

  /// All files in the folder but the lock.
  [[nodiscard]] std::vector<fs::path> files() const {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.path().filename() != ".lock") {
        files.push_back(entry.path());
      }
    }
    return files;
  }

  TempFolder temp;
  fs::path folder = temp.path() / "tiles" / "of_a_map";
};

/// Whether a map takes more than its budget because of what is within reach alone.
bool keeps_budget(const SparseMap& map, std::uint64_t budget, const Eigen::Vector3d& position_m) {
  if (map.held_bytes() <= budget) {
    return true;
  }
  for (const Eigen::Vector3i& brick : map.bricks()) {
    if (distance_m(position_m, tile_place(brick)) > kReachM) {
      return false;
    }
  }
  return true;
}

/// Whether all tiles within reach that the whole map knows are in memory.
bool has_what_is_near(const SparseMap& map, const SparseMap& whole, const Eigen::Vector3d& at_m) {
  for (const Eigen::Vector3i& brick : whole.bricks()) {
    const bool is_near = distance_m(at_m, tile_place(brick)) <= kReachM;
    if (is_near && whole.uniform(brick) != kUnknown && !map.holds_brick(brick)) {
      return false;
    }
  }
  return true;
}

TEST_F(MapTilesTest, AMapWithTilesIsTheMapWithout) {
  for (const std::uint64_t budget : {std::uint64_t{40} << 10U, std::uint64_t{300} << 10U}) {
    fs::remove_all(folder);
    SparseMap whole = empty_map();
    SparseMap map = empty_map();
    MapTiles tiles(folder, {budget, kReachM, Wanderer::kLimit});
    Wanderer drone(static_cast<unsigned>(budget), -2000, 2500);
    std::size_t most_away = 0;
    for (int i = 0; i < 250; ++i) {
      drone.fly();
      tiles.follow(drone.position_m(), map);
      ASSERT_TRUE(keeps_budget(map, budget, drone.position_m())) << "step " << i;
      ASSERT_TRUE(has_what_is_near(map, whole, drone.position_m())) << "step " << i;
      drone.see(9.0, map, whole);
      most_away = std::max(most_away, tiles.away_count());
      if (i % 100 == 50) {
        tiles.flush(map);
      }
    }
    EXPECT_GT(most_away, 10U);
    EXPECT_LT(map.brick_count(), whole.brick_count());
    tiles.bring_in_all(map);
    EXPECT_EQ(tiles.away_count(), 0U);
    EXPECT_EQ(difference(map, whole), "");
  }
}

TEST_F(MapTilesTest, ScansMayReachTilesThatAreAway) {
  SparseMap whole = empty_map();
  SparseMap map = empty_map();
  constexpr std::uint64_t kBudget = 40U << 10U;
  MapTiles tiles(folder, {kBudget, 1.0, Wanderer::kLimit});
  Wanderer drone(9, -3, 4);  // sums never come to the limit
  for (int i = 0; i < 100; ++i) {
    drone.fly();
    tiles.follow(drone.position_m(), map);
    drone.see(30.0, map, whole);
    if (i % 20 == 19) {
      tiles.flush(map);
    }
  }
  tiles.bring_in_all(map);
  EXPECT_EQ(difference(map, whole), "");
  tiles.flush(map);
  EXPECT_EQ(difference(saved(), whole), "");
}

TEST_F(MapTilesTest, WhatAScanSaidOfATileThatIsAwayIsAdded) {
  SparseMap map = empty_map();
  const Eigen::Vector3i near_limit = cell_of_tile(0) + Eigen::Vector3i::UnitX();
  const Eigen::Vector3i other = cell_of_tile(0) + Eigen::Vector3i(20, 0, 0);
  add(map, cell_of_tile(0), 1000);
  add(map, near_limit, 4900);
  add(map, other, -600);
  MapTiles tiles(folder, no_budget());
  tiles.follow(middle_m(5), map);
  EXPECT_EQ(map.brick_count(), 0U);
  EXPECT_EQ(tiles.away_count(), 1U);
  add(map, cell_of_tile(0), 300);
  add(map, near_limit, 300);
  EXPECT_EQ(map.at(cell_of_tile(0)), 300);
  tiles.follow(middle_m(0), map);
  EXPECT_EQ(map.at(cell_of_tile(0)), 1300);
  EXPECT_EQ(map.at(near_limit), Wanderer::kLimit);
  EXPECT_EQ(map.at(other), -600);
  EXPECT_EQ(tiles.away_count(), 0U);
  tiles.flush(map);
  EXPECT_EQ(difference(saved(), map), "");
}

TEST_F(MapTilesTest, AFlushKeepsWhatBothKnow) {
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 1000);
  MapTiles tiles(folder, no_budget());
  tiles.follow(middle_m(5), map);
  add(map, cell_of_tile(0), 300);
  tiles.flush(map);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 1300);
  add(map, cell_of_tile(0), 7);
  tiles.follow(middle_m(5), map);  // puts it out again
  EXPECT_EQ(map.brick_count(), 0U);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 1307);
}

TEST_F(MapTilesTest, WithinReachNothingIsPutOut) {
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 1000);
  add(map, cell_of_tile(1), 1000);
  add(map, cell_of_tile(2), 1000);
  MapTiles tiles(folder, no_budget());
  tiles.follow(middle_m(0), map);  // tile 1 is 8 m away, tile 2 is 24 m
  EXPECT_EQ(map.brick_count(), 2U);
  EXPECT_EQ(map.at(cell_of_tile(1)), 1000);
  EXPECT_EQ(map.at(cell_of_tile(2)), kUnknown);
}

TEST_F(MapTilesTest, WithinTheBudgetNothingIsPutOut) {
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 1000);
  MapTiles tiles(folder, large_budget());
  tiles.follow(middle_m(50), map);
  EXPECT_EQ(map.at(cell_of_tile(0)), 1000);
  EXPECT_TRUE(files().empty());
}

TEST_F(MapTilesTest, AFolderWithTilesIsThatMap) {
  SparseMap map = empty_map();
  {
    MapTiles tiles(folder, no_budget());
    add(map, cell_of_tile(-1), 1000);
    add(map, cell_of_tile(4), 2000);
    tiles.flush(map);
    EXPECT_EQ(map.brick_count(), 2U) << "a flush puts nothing out";
    add(map, cell_of_tile(4), 500);  // lost
  }
  MapTiles tiles(folder, no_budget());
  EXPECT_EQ(tiles.folder(), folder);
  EXPECT_EQ(tiles.away_count(), 2U);
  SparseMap again = empty_map();
  tiles.follow(middle_m(4), again);
  EXPECT_EQ(again.at(cell_of_tile(4)), 2000);
  EXPECT_EQ(again.at(cell_of_tile(-1)), kUnknown);
  tiles.follow(middle_m(-1), again);
  EXPECT_EQ(again.at(cell_of_tile(-1)), 1000);
  EXPECT_EQ(again.at(cell_of_tile(4)), kUnknown);
}

TEST_F(MapTilesTest, OtherFilesInTheFolderAreLeftAlone) {
  fs::create_directories(folder);
  for (const char* const name : {"notes.txt", "tile_1_2.skymap", "tile_01_2_3.skymap"}) {
    (void)temp.write(std::string("tiles/of_a_map/") + name, "x");
  }
  MapTiles tiles(folder, no_budget());
  SparseMap map = empty_map();
  EXPECT_EQ(tiles.away_count(), 0U);
  tiles.bring_in_all(map);
  tiles.flush(map);
  EXPECT_EQ(files().size(), 3U);
}

TEST_F(MapTilesTest, TheFolderIsOneRunsAtATime) {
  {
    const MapTiles tiles(folder, large_budget());
    const std::string message = message_of([&] { MapTiles(folder, large_budget()); });
    EXPECT_THAT(message, HasSubstr(folder.string()));
    EXPECT_THAT(message, HasSubstr("in use"));
  }
  EXPECT_NO_THROW(MapTiles(folder, large_budget()));
}

TEST_F(MapTilesTest, LeftoversAreLookedForOnceWhenTheFolderIsOpened) {
  const auto leave = [&](const std::string& name) {
    return temp.write("tiles/of_a_map/" + name, "half");
  };
  const fs::path earlier = leave(".tile_0_0_0.skymap.unfinished-abc123");
  const fs::path of_another_name = leave(".map.skymap.unfinished-abc123");
  MapTiles tiles(folder, large_budget());
  EXPECT_FALSE(fs::exists(earlier));
  EXPECT_TRUE(fs::exists(of_another_name));
  const fs::path later = leave(".tile_0_0_0.skymap.unfinished-abc123");
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 1000);
  tiles.flush(map);
  EXPECT_TRUE(fs::exists(later)) << "the folder was looked through again for a tile";
  EXPECT_EQ(saved().at(cell_of_tile(0)), 1000);
}

TEST_F(MapTilesTest, TheWholeMapsSizeIsKnownWithoutBringingItIn) {
  SparseMap map = empty_map();
  Wanderer drone(5, -2000, 2500);
  SparseMap whole = empty_map();
  MapTiles tiles(folder, no_budget());
  EXPECT_EQ(tiles.whole_bytes(map), 0U);
  for (int i = 0; i < 60; ++i) {
    drone.fly();
    tiles.follow(drone.position_m(), map);
    drone.see(9.0, map, whole);
  }
  tiles.flush(map);
  ASSERT_GT(tiles.away_count(), 2U);
  const std::uint64_t expected = tiles.whole_bytes(map);
  EXPECT_LT(map.held_bytes(), expected);
  tiles.bring_in_all(map);
  EXPECT_EQ(map.held_bytes(), expected);
  EXPECT_EQ(tiles.whole_bytes(map), expected);
}

TEST_F(MapTilesTest, ATileThatIsForgottenDoesNotComeBack) {
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 60);
  add(map, cell_of_tile(1), 4000);
  MapTiles tiles(folder, no_budget());
  tiles.flush(map);
  EXPECT_EQ(files().size(), 2U);
  map.begin_change();
  map.decay({.keep_occupied = 50000});
  tiles.follow(middle_m(9), map);
  tiles.follow(middle_m(0), map);
  EXPECT_EQ(map.at(cell_of_tile(0)), kUnknown);
  tiles.flush(map);
  EXPECT_EQ(files().size(), 1U);
  const SparseMap left = saved();
  EXPECT_EQ(left.at(cell_of_tile(0)), kUnknown);
  EXPECT_EQ(left.at(cell_of_tile(1)), 3051);  // 4000 * 50000 / 65536 = 3051.8
  add(map, cell_of_tile(0), 200);
  tiles.flush(map);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 200);
}

TEST_F(MapTilesTest, NorDoesABrickOfATileThatStays) {
  SparseMap map = empty_map();
  const Eigen::Vector3i fading = cell_of_tile(0) + Eigen::Vector3i(20, 0, 0);
  add(map, cell_of_tile(0), 4000);
  add(map, fading, 60);
  MapTiles tiles(folder, no_budget());
  tiles.flush(map);
  map.begin_change();
  map.decay({.keep_occupied = 50000});
  tiles.flush(map);
  EXPECT_EQ(saved().at(fading), kUnknown);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 3051);
}

TEST_F(MapTilesTest, NorDoesABrickThatIsErased) {
  SparseMap map = empty_map();
  const Eigen::Vector3i erased = cell_of_tile(0) + Eigen::Vector3i(40, 0, 0);
  add(map, cell_of_tile(0), 4000);
  add(map, erased, 4000);
  MapTiles tiles(folder, no_budget());
  tiles.flush(map);
  map.erase_brick(brick_of(erased));
  tiles.flush(map);
  EXPECT_EQ(saved().at(erased), kUnknown);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 4000);
}

TEST_F(MapTilesTest, ADecayIsSavedByTheNextFlush) {
  SparseMap map = empty_map();
  add(map, cell_of_tile(0), 4000);
  MapTiles tiles(folder, no_budget());
  tiles.flush(map);
  map.begin_change();
  map.decay({.keep_occupied = 32768});
  tiles.flush(map);
  EXPECT_EQ(saved().at(cell_of_tile(0)), 2000);
}

}  // namespace
}  // namespace skyhalo
