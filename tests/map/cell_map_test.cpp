#include "skyhalo/map/cell_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>
#include <vector>

#include "support/random_maps.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

static_assert(CellMap<DenseMap> && CellMap<LocalMap> && CellMap<SparseMap>);
static_assert(BrickMap<SparseMap> && !BrickMap<DenseMap> && !BrickMap<LocalMap>);
static_assert(ChangingMap<DenseMap> && ChangingMap<LocalMap> && ChangingMap<SparseMap>);

using CellKey = std::tuple<int, int, int>;

template <class Map>
std::map<CellKey, int> known_cells(const Map& map, const CellBox& box) {
  std::map<CellKey, int> cells;
  for_each_known_cell(map, box, [&cells](const Eigen::Vector3i& cell, LogOdds value) {
    const bool is_new = cells.emplace(CellKey{cell.x(), cell.y(), cell.z()}, value).second;
    EXPECT_TRUE(is_new);  // each once
  });
  return cells;
}

/// Asks for each cell of a box by itself.
template <class Map>
std::map<CellKey, int> naive_known_cells(const Map& map, const CellBox& box) {
  std::map<CellKey, int> cells;
  for (const reference::NaiveCell& cell : testing::cells_in(map, box)) {
    if (cell.known) {
      cells.emplace(CellKey{cell.index.x(), cell.index.y(), cell.index.z()}, cell.log_odds);
    }
  }
  return cells;
}

template <class Map>
void compare_known_cells(const Map& map) {
  const CellBox all = testing::known_and_rim(map);
  const CellBox part{all.min.array() + 7, all.max.array() - 9};
  EXPECT_GT(known_cells(map, part).size(), 100U);
  EXPECT_EQ(known_cells(map, part), naive_known_cells(map, part));
  EXPECT_EQ(known_cells(map, all), naive_known_cells(map, all));
  EXPECT_EQ(known_cells(map, whole_lattice()), naive_known_cells(map, all));
  EXPECT_THAT(known_cells(map, {all.max, all.min}), IsEmpty());
}

TEST(CellMapReference, KnownCellsAreThoseOfAllThatAreKnown) {
  compare_known_cells(testing::random_dense_map(0.01, 1));
  compare_known_cells(testing::random_local_map(0.01, 2));
  compare_known_cells(testing::random_sparse_map(0.01, 3));
}

TEST(CellMapTest, StopsWhenItIsTold) {
  const DenseMap map = testing::random_dense_map(0.01, 1);
  int visits = 0;
  EXPECT_FALSE(for_each_known_block(map, map.bounds(), [&visits](const CellBox&, LogOdds) {
    ++visits;
    return visits < 5;
  }));
  EXPECT_EQ(visits, 5);
}

TEST(CellMapTest, VisitsABrickOfOneNumberAtOnce) {
  SparseMap map(VoxelLattice{});
  map.set_uniform({0, 0, 1}, -300);
  std::vector<CellBox> blocks;
  for_each_known_block(map, {{-5, 2, 0}, {3, 99, 99}}, [&](const CellBox& cells, LogOdds value) {
    EXPECT_EQ(value, -300);
    blocks.push_back(cells);
    return true;
  });
  EXPECT_THAT(blocks, ElementsAre(CellBox{{0, 2, 8}, {3, 8, 16}}));
}

TEST(CellMapTest, CountsBoxesOfAnySize) {
  EXPECT_EQ(count_of({{0, 0, 0}, {2, 3, 4}}), 24.0);
  EXPECT_EQ(count_of({{0, 0, 0}, {2, -3, 4}}), 0.0);
  EXPECT_EQ(count_of(whole_lattice()), std::pow(2.0, 75.0));
}

template <class Map>
std::vector<CellKey> changed_bricks(const Map& map, std::uint64_t since_tick) {
  std::vector<CellKey> bricks;
  for_each_changed_brick(map, since_tick, [&bricks](const Eigen::Vector3i& brick) {
    bricks.emplace_back(brick.x(), brick.y(), brick.z());
  });
  return bricks;
}

template <class Map>
void expect_changed_bricks(Map map) {
  const std::uint64_t start = map.tick();
  EXPECT_THAT(changed_bricks(map, start), IsEmpty());
  map.begin_change();
  map.set({1, 2, 3}, 100);
  const std::uint64_t first = map.tick();
  map.begin_change();
  map.set({9, 2, 3}, 100);
  map.set({9, 3, 3}, 100);
  map.set({1, 2, 17}, 100);
  EXPECT_THAT(changed_bricks(map, start),
              UnorderedElementsAre(CellKey(0, 0, 0), CellKey(1, 0, 0), CellKey(0, 0, 2)));
  EXPECT_THAT(changed_bricks(map, first), UnorderedElementsAre(CellKey(1, 0, 0), CellKey(0, 0, 2)));
  EXPECT_THAT(changed_bricks(map, map.tick()), IsEmpty());
}

TEST(CellMapTest, FindsTheBricksThatChanged) {
  expect_changed_bricks(DenseMap(VoxelGrid{Eigen::Vector3d::Zero(), 0.5, {20, 20, 20}}));
  expect_changed_bricks(LocalMap({40, 40, 40}, 0.5));
  expect_changed_bricks(SparseMap(VoxelLattice{}));
}

}  // namespace
}  // namespace skyhalo
