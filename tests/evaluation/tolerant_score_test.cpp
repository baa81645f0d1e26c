#include "skyhalo/evaluation/tolerant_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace skyhalo {
namespace {

constexpr LogOdds kOccupied = 3000;
constexpr LogOdds kFree = -3000;

/// A row of ten cells along x.
struct Row {
  VoxelGrid grid{Eigen::Vector3d::Zero(), 1.0, {10, 1, 1}};
  std::vector<LogOdds> map = std::vector<LogOdds>(10, kFree);
  std::vector<std::uint8_t> exact = std::vector<std::uint8_t>(10, 0);
  std::vector<std::uint8_t> counted = std::vector<std::uint8_t>(10, 1);

  [[nodiscard]] TolerantScore score() const {
    return tolerant_score({grid, map, exact, counted}, 0.7);
  }
};

TEST(TolerantScoreTest, ACellBesideTheRightOneWillDo) {
  Row row;
  row.exact[4] = 1;
  row.map[5] = kOccupied;
  const TolerantScore score = row.score();
  EXPECT_EQ(score.claimed, 1);
  EXPECT_EQ(score.claimed_right, 1);
  EXPECT_EQ(score.exact, 1);
  EXPECT_EQ(score.exact_found, 1);
}

TEST(TolerantScoreTest, TwoCellsAsideIsWrong) {
  Row row;
  row.exact[4] = 1;
  row.exact[9] = 1;
  row.map[6] = kOccupied;
  row.map[9] = kOccupied;
  const TolerantScore score = row.score();
  EXPECT_DOUBLE_EQ(score.precision(), 0.5);
  EXPECT_DOUBLE_EQ(score.recall(), 0.5);
}

TEST(TolerantScoreTest, CellsThatAreNotCountedAreNeighboursAllTheSame) {
  Row row;
  row.exact[4] = 1;
  row.map[5] = kOccupied;
  row.counted[5] = 0;
  const TolerantScore score = row.score();
  EXPECT_EQ(score.claimed, 0);
  EXPECT_EQ(score.exact_found, 1);
  EXPECT_TRUE(std::isnan(score.precision()));
}

TEST(TolerantScoreTest, UnknownAndUnsureCellsAreNotOccupied) {
  Row row;
  row.exact[4] = 1;
  row.map[4] = kUnknown;
  row.map[3] = 800;  // p = 0.69
  EXPECT_EQ(row.score().claimed, 0);
  EXPECT_DOUBLE_EQ(row.score().recall(), 0.0);
}

TEST(TolerantScoreTest, CornersAreNeighboursInThreeDimensions) {
  const VoxelGrid grid{Eigen::Vector3d::Zero(), 1.0, {3, 3, 3}};
  std::vector<LogOdds> map(27, kFree);
  std::vector<std::uint8_t> exact(27, 0);
  const std::vector<std::uint8_t> counted(27, 1);
  map[static_cast<std::size_t>(grid.offset_of({0, 0, 0}))] = kOccupied;
  exact[static_cast<std::size_t>(grid.offset_of({1, 1, 1}))] = 1;
  EXPECT_DOUBLE_EQ(tolerant_score({grid, map, exact, counted}, 0.7).precision(), 1.0);
}

}  // namespace
}  // namespace skyhalo
