#include "skyhalo/geometry/voxel_lattice.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "skyhalo/geometry/lattice_walk.hpp"

namespace skyhalo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kReach = VoxelLattice::kReach;

VoxelLattice half_metres() {
  return {.origin_m = {-1.0, 0.25, 10.0}, .voxel_m = 0.5};
}

std::vector<CellBox> pieces_of(const CellBox& box, const CellBox& without) {
  std::vector<CellBox> pieces;
  for_each_piece_without(box, without, [&](const CellBox& piece) { pieces.push_back(piece); });
  return pieces;
}

/// A box about the origin; a few are empty, or even inside out.
CellBox random_box(std::mt19937& random) {
  std::uniform_int_distribution<int> at(-5, 3);
  std::uniform_int_distribution<int> size(1, 8);
  CellBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = at(random);
    box.max[axis] = box.min[axis] + (random() % 20U == 0 ? 1 - size(random) : size(random));
  }
  return box;
}

TEST(VoxelLatticeTest, APointIsInItsHalfOpenCell) {
  const VoxelLattice lattice = half_metres();
  EXPECT_EQ(lattice.cell_of({-1.0, 0.25, 10.0}), Eigen::Vector3i(0, 0, 0));
  EXPECT_EQ(lattice.cell_of({-0.501, 0.749, 10.499}), Eigen::Vector3i(0, 0, 0));
  EXPECT_EQ(lattice.cell_of({-0.5, 0.75, 10.5}), Eigen::Vector3i(1, 1, 1));
  EXPECT_EQ(lattice.cell_of({-1.001, 0.249, 9.999}), Eigen::Vector3i(-1, -1, -1));
  EXPECT_EQ(lattice.cell_of({-1.5, -0.25, 9.5}), Eigen::Vector3i(-1, -1, -1));
}

TEST(VoxelLatticeTest, CornersAndCentresOfCells) {
  const VoxelLattice lattice = half_metres();
  EXPECT_EQ(lattice.corner_m({0, 0, 0}), lattice.origin_m);
  EXPECT_EQ(lattice.corner_m({2, -1, 4}), Eigen::Vector3d(0.0, -0.25, 12.0));
  EXPECT_EQ(lattice.center_m({2, -1, 4}), Eigen::Vector3d(0.25, 0.0, 12.25));
}

TEST(VoxelLatticeTest, PointsBeyondFallIntoTheOutermostCells) {
  const VoxelLattice lattice;
  EXPECT_EQ(lattice.cell_of({kReach - 0.5, -kReach, kReach}),
            Eigen::Vector3i(kReach - 1, -kReach, kReach - 1));
  EXPECT_EQ(lattice.cell_of({1e300, -1e300, kInf}),
            Eigen::Vector3i(kReach - 1, -kReach, kReach - 1));
  EXPECT_EQ(lattice.cell_of({-kInf, -kReach - 0.5, 0.0}), Eigen::Vector3i(-kReach, -kReach, 0));
  const int of_nan = lattice.cell_of({kNan, 0.0, 0.0}).x();
  EXPECT_TRUE(of_nan == -kReach || of_nan == kReach - 1) << of_nan;
}

TEST(VoxelLatticeTest, TheWholeLatticeIsWhatCanBeNumbered) {
  const CellBox whole = whole_lattice();
  EXPECT_TRUE(whole.holds(VoxelLattice{}.cell_of({1e300, -1e300, 1e300})));
  EXPECT_FALSE(whole.holds({kReach, 0, 0}));
  EXPECT_FALSE(whole.holds({0, -kReach - 1, 0}));
  EXPECT_EQ(whole.size(), Eigen::Vector3i::Constant(2 * kReach));
}

TEST(VoxelLatticeTest, CellsTouchingABoxHoldItsFaces) {
  const VoxelLattice lattice = half_metres();
  EXPECT_EQ(cells_touching(lattice, {-0.9, 0.3, 10.1}, {-0.6, 0.7, 10.4}),
            (CellBox{{0, 0, 0}, {1, 1, 1}}));
  // The far faces lie in the next cells.
  EXPECT_EQ(cells_touching(lattice, {-1.0, 0.25, 10.0}, {-0.5, 0.75, 10.5}),
            (CellBox{{0, 0, 0}, {2, 2, 2}}));
}

TEST(CellBoxTest, CountsItsCells) {
  const CellBox box{{-1, 2, 5}, {3, 3, 7}};
  EXPECT_EQ(box.size(), Eigen::Vector3i(4, 1, 2));
  EXPECT_EQ(box.cell_count(), 8);
  EXPECT_FALSE(box.empty());
  EXPECT_TRUE(box.holds({-1, 2, 6}));
  EXPECT_FALSE(box.holds({3, 2, 6}));
  EXPECT_FALSE(box.holds({0, 3, 6}));
  EXPECT_FALSE(box.holds({0, 2, 4}));
  const std::int64_t side = 2 * std::int64_t{kReach};
  EXPECT_EQ((CellBox{{-kReach, -kReach, 0}, {kReach, kReach, 4096}}.cell_count()),
            side * side * 4096);
}

TEST(CellBoxTest, InsideOutIsEmpty) {
  const CellBox box{{1, 0, 0}, {0, 5, 5}};
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.size(), Eigen::Vector3i(0, 5, 5));
  EXPECT_EQ(box.cell_count(), 0);
  EXPECT_TRUE(CellBox{}.empty());
}

TEST(CellBoxTest, AHoleInTheMiddleLeavesSixPieces) {
  const CellBox box{{0, 0, 0}, {3, 3, 3}};
  EXPECT_EQ(pieces_of(box, {{1, 1, 1}, {2, 2, 2}}).size(), 6U);
  EXPECT_TRUE(pieces_of(box, box).empty());
  EXPECT_EQ(pieces_of(box, {{3, 0, 0}, {5, 3, 3}}), std::vector<CellBox>{box});
}

TEST(CellBoxProperty, AnOverlapHoldsTheCellsOfBoth) {
  std::mt19937 random(3);
  for (int round = 0; round < 500; ++round) {
    const CellBox a = random_box(random);
    const CellBox b = random_box(random);
    const CellBox both = overlap(a, b);
    for_each_cell({Eigen::Vector3i::Constant(-7), Eigen::Vector3i::Constant(13)},
                  [&](const auto& c) {
                    EXPECT_EQ(both.holds(c), a.holds(c) && b.holds(c));
                    return !HasFailure();
                  });
  }
}

TEST(CellBoxProperty, PiecesAreDisjointAndTogetherWhatIsLeft) {
  std::mt19937 random(17);
  int cut = 0;
  for (int round = 0; round < 2000; ++round) {
    const CellBox box = random_box(random);
    const CellBox without = random_box(random);
    const std::vector<CellBox> pieces = pieces_of(box, without);
    ASSERT_LE(pieces.size(), 6U);
    cut += pieces.size() > 1 ? 1 : 0;
    std::int64_t left = 0;
    for_each_cell(box, [&](const Eigen::Vector3i& cell) {
      int holding = 0;
      for (const CellBox& piece : pieces) {
        holding += piece.holds(cell) ? 1 : 0;
      }
      EXPECT_EQ(holding, without.holds(cell) ? 0 : 1) << cell.transpose();
      left += holding;
      return !HasFailure();
    });
    // No cells of other places.
    std::int64_t in_pieces = 0;
    for (const CellBox& piece : pieces) {
      in_pieces += piece.cell_count();
    }
    ASSERT_EQ(in_pieces, left);
  }
  EXPECT_GT(cut, 300);
}

TEST(VoxelLatticeProperty, EveryCellHoldsItsCentre) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> index(-kReach, kReach - 1);
  std::uniform_real_distribution<double> origin_m(-50.0, 50.0);
  std::uniform_real_distribution<double> voxel_m(0.01, 3.0);
  for (int round = 0; round < 5000; ++round) {
    const VoxelLattice lattice{{origin_m(random), origin_m(random), origin_m(random)},
                               voxel_m(random)};
    const Eigen::Vector3i cell(index(random), index(random), index(random));
    ASSERT_EQ(lattice.cell_of(lattice.center_m(cell)), cell);
    const Eigen::Vector3d half_m = lattice.center_m(cell) - lattice.corner_m(cell);
    ASSERT_LT((half_m.array() - 0.5 * lattice.voxel_m).abs().maxCoeff(), 1e-7);
  }
}

}  // namespace
}  // namespace skyhalo
