#include "skyhalo/geometry/capsule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "reference/naive_map_query.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

const Eigen::AlignedBox3d kUnitBox(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());

double distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  return std::sqrt(squared_distance_m2({from_m, to_m}, kUnitBox));
}

TEST(CapsuleTest, MeasuresFromASegmentToABox) {
  EXPECT_NEAR(distance_m({2.0, 0.5, 0.5}, {3.0, 0.5, 0.5}), 1.0, 1e-12);   // the nearer end
  EXPECT_NEAR(distance_m({3.0, 0.5, 0.5}, {2.0, 0.5, 0.5}), 1.0, 1e-12);   // in either direction
  EXPECT_NEAR(distance_m({-5.0, 0.5, 1.3}, {5.0, 0.5, 1.3}), 0.3, 1e-12);  // past a face
  EXPECT_NEAR(distance_m({-5.0, 1.3, 1.4}, {5.0, 1.3, 1.4}), 0.5, 1e-12);  // past an edge
  // Across an edge: the line x + y = 3 passes (1, 1) at 1 / sqrt 2.
  EXPECT_NEAR(distance_m({3.0, 0.0, 0.5}, {0.0, 3.0, 0.5}), std::sqrt(0.5), 1e-12);
  // Past a corner: the line from (3, 0, 0) + ... of x + y + z = 4.5 in the plane y = z.
  EXPECT_NEAR(distance_m({4.5, 0.0, 0.0}, {0.0, 2.25, 2.25}), 1.5 * std::sqrt(1.0 / 3.0), 1e-12);
}

TEST(CapsuleTest, IsZeroWhereTheyMeet) {
  EXPECT_EQ(distance_m({-1.0, 0.2, 0.4}, {2.0, 0.7, 0.5}), 0.0);
  EXPECT_EQ(distance_m({0.2, 0.2, 0.2}, {0.3, 0.4, 0.5}), 0.0);
  EXPECT_EQ(distance_m({1.0, 0.5, 0.5}, {2.0, 0.5, 0.5}), 0.0);
}

TEST(CapsuleTest, MeasuresFromAPoint) {
  const Eigen::Vector3d point_m(2.0, 3.0, 3.0);
  EXPECT_NEAR(distance_m(point_m, point_m), 3.0, 1e-12);
}

TEST(CapsuleTest, TouchesFaces) {
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 0.5};
  const Capsule capsule{{{0.25, 0.25, 0.25}, {0.25, 0.25, 0.25}}, 0.25};
  EXPECT_TRUE(touches(capsule, lattice, {1, 0, 0}));  // at (0.5, 0.25, 0.25)
  EXPECT_TRUE(touches(capsule, lattice, {-1, 0, 0}));
  EXPECT_FALSE(touches(capsule, lattice, {1, 1, 0}));
  int cells = 0;
  for_each_cell_of(lattice, capsule, whole_lattice(), [&cells](const Eigen::Vector3i&) {
    ++cells;
    return true;
  });
  EXPECT_EQ(cells, 7);
}

TEST(CapsuleTest, TellsWhatIsNone) {
  EXPECT_TRUE((Capsule{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 0.0}.is_valid()));
  EXPECT_FALSE((Capsule{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, -0.1}.is_valid()));
  EXPECT_FALSE((Capsule{{{0.0, 0.0, 0.0}, {std::nan(""), 0.0, 0.0}}, 0.1}.is_valid()));
  EXPECT_FALSE((Capsule{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, std::nan("")}.is_valid()));
  EXPECT_FALSE((Capsule{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, HUGE_VAL}.is_valid()));
}

using CellKey = std::tuple<int, int, int>;

TEST(CapsuleReference, ReachesTheCellsThatAreNearEnough) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> position_m(-2.0, 2.0);
  std::uniform_real_distribution<double> radius_m(0.0, 0.8);
  const VoxelLattice lattice{{0.07, -0.02, 0.11}, 0.25};
  const CellBox all =
      cells_touching(lattice, Eigen::Vector3d::Constant(-3.2), Eigen::Vector3d::Constant(3.2));
  for (int i = 0; i < testing::rounds(12); ++i) {
    Capsule capsule{{{position_m(rng), position_m(rng), position_m(rng)},
                     {position_m(rng), position_m(rng), position_m(rng)}},
                    i % 4 == 0 ? 0.0 : radius_m(rng)};
    if (i % 3 == 0) {
      capsule.axis.to_m.y() = capsule.axis.from_m.y();  // level
    }
    std::set<CellKey> expected;
    for_each_cell(all, [&](const Eigen::Vector3i& cell) {
      if (reference::naive_segment_distance_m({cell, lattice.corner_m(cell), 0.25, 0, true},
                                              capsule.axis.from_m,
                                              capsule.axis.to_m) <= capsule.radius_m) {
        expected.emplace(cell.x(), cell.y(), cell.z());
      }
      return true;
    });
    std::set<CellKey> seen;
    double visits = 0;
    for_each_cell_of(lattice, capsule, whole_lattice(), [&](const Eigen::Vector3i& cell) {
      seen.emplace(cell.x(), cell.y(), cell.z());
      ++visits;
      return true;
    });
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(static_cast<double>(seen.size()), visits);  // each once
    EXPECT_GT(seen.size(), 5U);
    EXPECT_LE(visits, cells_to_look_at(lattice, capsule, whole_lattice()));
  }
}

TEST(CapsuleTest, StaysWithinTheBox) {
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 0.5};
  const Capsule capsule{{{-3.0, 0.1, 0.1}, {3.0, 0.4, 0.2}}, 0.4};
  const CellBox within{{-1, 0, 0}, {2, 1, 2}};
  int cells = 0;
  EXPECT_TRUE(for_each_cell_of(lattice, capsule, within, [&](const Eigen::Vector3i& cell) {
    EXPECT_TRUE(within.holds(cell));
    ++cells;
    return true;
  }));
  EXPECT_EQ(cells, 6);
  EXPECT_FALSE(
      for_each_cell_of(lattice, capsule, within, [](const Eigen::Vector3i&) { return false; }));
}

}  // namespace
}  // namespace skyhalo
