#include "skyhalo/map/update_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "support/instruction_set.hpp"

namespace skyhalo {
namespace {

using testing::InstructionSet;

constexpr LogOdds kMost = 32767;

/// Cells and increments at which something changes, with their neighbours.
std::vector<LogOdds> cells_of_interest() {
  return {kUnknown,
          -32767,
          -32766,
          -5001,
          -5000,
          -4999,
          -848,
          -1,
          0,
          1,
          2,
          847,
          4999,
          5000,
          5001,
          1234,
          kMost};
}

std::vector<Increment> increments_of_interest() {
  return {kUnknown, -32767, -10000, -5000, -847, -1, 0, 1, 25, 1946, 5000, 10000, 32766, kMost};
}

std::vector<int> limits_of_interest() {
  return {1, 2, 847, 4999, 5000, 5001, 32766, 32767};
}

/// What the header promises of one cell.
LogOdds expected(LogOdds cell, Increment increment, int limit) {
  return increment == 0 ? cell : updated(cell, increment, limit);
}

/// All rows of a brick.
std::vector<LogOddsRow> whole_rows(BrickCells& cells) {
  std::vector<LogOddsRow> rows(std::size_t{kBrickEdge} * kBrickEdge);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t place = row * kBrickEdge;
    rows[row] = {cells.cells.data() + place, static_cast<int>(place), kBrickEdge};
  }
  return rows;
}

/// Runs a check with every instruction set that this machine has.
class UpdateCellsTest : public ::testing::Test {
 protected:
  template <class Check>
  static void with_each_set(Check&& check) {
    ASSERT_FALSE(InstructionSet::all().empty());
    for (const std::int64_t target : InstructionSet::all()) {
      SCOPED_TRACE(InstructionSet::name(target));
      const InstructionSet in_use(target);
      check();
    }
  }
};

TEST_F(UpdateCellsTest, EveryCellWithEveryIncrementAndLimit) {
  with_each_set([] {
    for (const LogOdds cell : cells_of_interest()) {
      for (const Increment increment : increments_of_interest()) {
        for (const int limit : limits_of_interest()) {
          std::array<LogOdds, kBrickEdge> each{};
          each.fill(cell);
          std::array<LogOdds, kBrickEdge> one = each;
          BrickCells increments{};
          increments.cells.fill(increment);
          const LogOdds after = expected(cell, increment, limit);
          const std::array each_row{LogOddsRow{each.data(), 16, kBrickEdge}};
          const std::array one_row{LogOddsRow{one.data(), 16, kBrickEdge}};
          ASSERT_EQ(add_increments(each_row, increments, limit), after != cell)
              << cell << " by " << increment << " within " << limit;
          ASSERT_EQ(add_increment(one_row, increment, limit), after != cell)
              << cell << " by " << increment << " within " << limit;
          for (std::size_t i = 0; i < each.size(); ++i) {
            ASSERT_EQ(each[i], after) << cell << " by " << increment << " within " << limit;
            ASSERT_EQ(one[i], after) << cell << " by " << increment << " within " << limit;
          }
        }
      }
    }
  });
}

TEST_F(UpdateCellsTest, APartOfARowChangesAloneAndByItsOwnIncrements) {
  with_each_set([] {
    for (int first = 0; first < kBrickEdge; ++first) {
      for (int count = 0; count <= kBrickEdge - first; ++count) {
        std::array<LogOdds, std::size_t{4} * kBrickEdge> memory{};
        memory.fill(100);
        BrickCells increments{};
        for (std::size_t i = 0; i < kBrickCells; ++i) {
          increments.cells[i] = static_cast<Increment>(1 + i);
        }
        const int place = 3 * kBrickEdge + first;
        const std::array rows{LogOddsRow{memory.data() + kBrickEdge, place, count}};
        ASSERT_EQ(add_increments(rows, increments, 5000), count > 0);
        for (int i = 0; i < 4 * kBrickEdge; ++i) {
          const int of_row = i - kBrickEdge;
          const int added = of_row >= 0 && of_row < count ? 1 + place + of_row : 0;
          ASSERT_EQ(memory[static_cast<std::size_t>(i)], 100 + added)
              << count << " from " << first << ", cell " << i;
        }
        ASSERT_EQ(add_increment(rows, -50, 5000), count > 0);
        ASSERT_EQ(memory[kBrickEdge - 1], 100);
        ASSERT_EQ(memory[static_cast<std::size_t>(kBrickEdge + count)], 100);
      }
    }
  });
}

TEST_F(UpdateCellsTest, OneChangedCellOfABrickIsEnough) {
  with_each_set([] {
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      BrickCells cells{};
      cells.cells.fill(5000);
      BrickCells increments{};
      increments.cells.fill(900);  // at their limit
      const std::vector<LogOddsRow> rows = whole_rows(cells);
      ASSERT_FALSE(add_increments(rows, increments, 5000));
      cells.cells[place] = 4999;
      ASSERT_TRUE(add_increments(rows, increments, 5000)) << place;
      ASSERT_EQ(cells.cells[place], 5000);
      cells.cells[place] = kUnknown;
      ASSERT_TRUE(add_increment(rows, 7, 5000)) << place;
      ASSERT_EQ(cells.cells[place], 7);
    }
  });
}

TEST_F(UpdateCellsTest, AnIncrementOfNothingLeavesUnknownUnknown) {
  with_each_set([] {
    std::array<LogOdds, kBrickEdge> cells{};
    cells.fill(kUnknown);
    BrickCells increments{};
    increments.cells.fill(0);
    increments.cells[2] = -30;
    const std::array rows{LogOddsRow{cells.data(), 0, kBrickEdge}};
    EXPECT_FALSE(add_increment(rows, 0, 5000));
    EXPECT_TRUE(add_increments(rows, increments, 5000));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      EXPECT_EQ(cells[i], i == 2 ? -30 : kUnknown);
    }
  });
}

TEST_F(UpdateCellsTest, NoRowsAreNoChange) {
  with_each_set([] {
    BrickCells increments{};
    increments.cells.fill(900);
    EXPECT_FALSE(add_increments(std::span<const LogOddsRow>(), increments, 5000));
    EXPECT_FALSE(add_increment(std::span<const LogOddsRow>(), 900, 5000));
  });
}

/// Rows of a brick as they may lie in memory: whole, in two pieces, or partly missing.
std::vector<LogOddsRow> random_rows(BrickCells& cells, std::mt19937& random) {
  std::vector<LogOddsRow> rows;
  for (int row = 0; row < kBrickEdge * kBrickEdge; ++row) {
    const int first = row * kBrickEdge;
    const int cut = static_cast<int>(random() % (kBrickEdge + 1U));
    const auto from = [&](int place) { return cells.cells.data() + place; };
    switch (random() % 4U) {
      case 0:
        rows.push_back({from(first), first, kBrickEdge});
        break;
      case 1:
        rows.push_back({from(first), first, cut});
        rows.push_back({from(first + cut), first + cut, kBrickEdge - cut});
        break;
      case 2:
        rows.push_back({from(first + cut), first + cut, kBrickEdge - cut});
        break;
      default:
        break;
    }
  }
  return rows;
}

/// Cells of which a quarter is unknown, and increments of which a third is nothing.
void fill_at_random(BrickCells& cells, BrickCells& increments, std::mt19937& random) {
  std::uniform_int_distribution<int> any(-32768, 32767);
  for (std::size_t i = 0; i < kBrickCells; ++i) {
    cells.cells[i] = random() % 4U == 0 ? kUnknown : static_cast<LogOdds>(any(random) / 4);
    increments.cells[i] = random() % 3U == 0 ? Increment{0} : static_cast<Increment>(any(random));
  }
}

/// What rows of a brick's cells become, one by one.
BrickCells updated_one_by_one(const std::vector<LogOddsRow>& rows,
                              const BrickCells& cells,
                              const BrickCells& increments,
                              int limit) {
  BrickCells after = cells;
  for (const LogOddsRow& row : rows) {
    for (int place = row.place; place < row.place + row.count; ++place) {
      const auto at = static_cast<std::size_t>(place);
      after.cells[at] = expected(cells.cells[at], increments.cells[at], limit);
    }
  }
  return after;
}

TEST(UpdateCellsProperty, AgreesWithUpdatedCellByCell) {
  for (const std::int64_t target : InstructionSet::all()) {
    SCOPED_TRACE(InstructionSet::name(target));
    const InstructionSet in_use(target);
    std::mt19937 random(23);
    for (int round = 0; round < 2000; ++round) {
      const int limit = round % 3 == 0 ? 5000 : 1 + static_cast<int>(random() % 32767U);
      BrickCells cells{};
      BrickCells increments{};
      fill_at_random(cells, increments, random);
      const bool by_one = round % 2 == 0;
      const Increment one = increments.cells[7];
      if (by_one) {
        increments.cells.fill(one);
      }
      const std::vector<LogOddsRow> rows = random_rows(cells, random);
      const BrickCells after = updated_one_by_one(rows, cells, increments, limit);
      const bool changes = after.cells != cells.cells;
      ASSERT_EQ(by_one ? add_increment(rows, one, limit) : add_increments(rows, increments, limit),
                changes);
      ASSERT_EQ(cells.cells, after.cells) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace skyhalo
