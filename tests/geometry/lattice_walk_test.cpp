#include "skyhalo/geometry/lattice_walk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "reference/naive_map_query.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Crossing {
  Eigen::Vector3i cell;
  double enter_m = 0.0;
  double leave_m = 0.0;
};

const VoxelLattice kHalfMetre{Eigen::Vector3d::Zero(), 0.5};

std::vector<Crossing> walk(const VoxelLattice& lattice, const Ray& ray, double max_m) {
  std::vector<Crossing> crossings;
  walk_lattice(
      lattice, ray, max_m, [&](const Eigen::Vector3i& cell, double enter_m, double leave_m) {
        crossings.push_back({cell, enter_m, leave_m});
        return true;
      });
  return crossings;
}

std::vector<Eigen::Vector3i> cells(const Ray& ray, double max_m) {
  std::vector<Eigen::Vector3i> result;
  for (const Crossing& crossing : walk(kHalfMetre, ray, max_m)) {
    result.push_back(crossing.cell);
  }
  return result;
}

Eigen::Vector3i cell(int x, int y, int z) {
  return {x, y, z};
}

TEST(LatticeWalkTest, GoesThroughNegativeCells) {
  const std::vector<Crossing> seen = walk(kHalfMetre, {{-0.7, 0.2, -0.1}, {1.0, 0.0, 0.0}}, 1.0);
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].cell, cell(-2, 0, -1));
  EXPECT_EQ(seen[0].enter_m, 0.0);
  EXPECT_NEAR(seen[0].leave_m, 0.2, 1e-12);
  EXPECT_EQ(seen[1].cell, cell(-1, 0, -1));
  EXPECT_NEAR(seen[1].leave_m, 0.7, 1e-12);
  EXPECT_EQ(seen[2].cell, cell(0, 0, -1));
  EXPECT_NEAR(seen[2].enter_m, 0.7, 1e-12);
  EXPECT_EQ(seen[2].leave_m, 1.0);  // cut to the range
}

TEST(LatticeWalkTest, StartsOnAFaceInTheCellItGoesInto) {
  EXPECT_THAT(cells({{1.0, 0.2, 0.2}, {1.0, 0.0, 0.0}}, 0.3), ElementsAre(cell(2, 0, 0)));
  EXPECT_THAT(cells({{1.0, 0.2, 0.2}, {-1.0, 0.0, 0.0}}, 0.3), ElementsAre(cell(1, 0, 0)));
}

TEST(LatticeWalkTest, DoesNotEnterTheCellAtItsEnd) {
  EXPECT_THAT(cells({{0.25, 0.2, 0.2}, {1.0, 0.0, 0.0}}, 0.25), ElementsAre(cell(0, 0, 0)));
}

TEST(LatticeWalkTest, PassesThroughEdges) {
  // Along the diagonal of the xy cells: no cell beside it is crossed.
  const Ray ray{{0.25, 0.25, 0.2}, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()};
  EXPECT_THAT(cells(ray, 1.2), ElementsAre(cell(0, 0, 0), cell(1, 1, 0), cell(2, 2, 0)));
}

TEST(LatticeWalkTest, StopsWhenItIsTold) {
  int visits = 0;
  walk_lattice(kHalfMetre,
               Ray{},
               kInfinity,
               [&visits](const Eigen::Vector3i& /*cell*/, double /*enter_m*/, double /*leave_m*/) {
                 ++visits;
                 return visits < 4;
               });
  EXPECT_EQ(visits, 4);
}

TEST(LatticeWalkTest, WalksAPart) {
  std::vector<double> enters_m;
  walk_lattice(kHalfMetre,
               Ray{},
               RayInterval{0.6, 1.2},
               [&](const Eigen::Vector3i& /*cell*/, double enter_m, double /*leave_m*/) {
                 enters_m.push_back(enter_m);
                 return true;
               });
  EXPECT_THAT(enters_m, ElementsAre(0.6, 1.0));
}

TEST(LatticeWalkTest, ComesToTheEndOfTheLattice) {
  const double end_m = 0.5 * VoxelLattice::kReach;
  const std::vector<Crossing> seen =
      walk(kHalfMetre, {{end_m - 0.7, 0.2, 0.2}, {1.0, 0.0, 0.0}}, kInfinity);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen.back().cell.x(), VoxelLattice::kReach - 1);
  EXPECT_NEAR(seen.back().leave_m, 0.7, 1e-9);
  EXPECT_THAT(walk(kHalfMetre, {{end_m + 1.0, 0.2, 0.2}, {1.0, 0.0, 0.0}}, kInfinity), IsEmpty());
}

TEST(LatticeWalkTest, GoesNowhereWithoutANumber) {
  EXPECT_THAT(cells({{0.2, kNan, 0.2}, {1.0, 0.0, 0.0}}, 3.0), IsEmpty());
  EXPECT_THAT(cells({{0.2, 0.2, 0.2}, {kNan, 0.0, 0.0}}, 3.0), IsEmpty());
  EXPECT_THAT(cells({{0.2, 0.2, 0.2}, Eigen::Vector3d::Zero()}, 3.0), IsEmpty());
  EXPECT_THAT(cells({{kInfinity, 0.2, 0.2}, {1.0, 0.0, 0.0}}, 3.0), IsEmpty());
  EXPECT_THAT(cells(Ray{}, kNan), IsEmpty());
  EXPECT_THAT(cells(Ray{}, -1.0), IsEmpty());
}

TEST(LatticeWalkTest, ClipsToABoxOfCells) {
  const RayInterval part =
      clip(Ray{{-1.0, 0.2, 0.2}, {1.0, 0.0, 0.0}}, kHalfMetre, {{2, 0, 0}, {5, 1, 1}});
  EXPECT_NEAR(part.enter_m, 2.0, 1e-12);
  EXPECT_NEAR(part.leave_m, 3.5, 1e-12);
}

TEST(LatticeWalkReference, CrossesTheCellsThatTheRayCuts) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> position_m(-2.0, 2.0);
  std::normal_distribution<double> normal;
  const VoxelLattice lattice{{0.13, -0.21, 0.34}, 0.3};
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{position_m(rng), position_m(rng), position_m(rng)},
                  Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized()};
    const double max_m = 2.0;
    const std::vector<Crossing> seen = walk(lattice, ray, max_m);
    std::size_t matched = 0;
    const CellBox all = cells_touching(
        lattice, ray.origin_m.array() - max_m - 0.5, ray.origin_m.array() + max_m + 0.5);
    for_each_cell(all, [&](const Eigen::Vector3i& index) {
      const auto chord = reference::naive_stretch(
          {index, lattice.corner_m(index), 0.3, 0, true}, ray.origin_m, ray.direction);
      if (chord && std::min(chord->leave, max_m) > std::max(chord->enter, 0.0) + 1e-9) {
        const auto found = std::find_if(
            seen.begin(), seen.end(), [&](const Crossing& c) { return c.cell == index; });
        EXPECT_NE(found, seen.end());
        if (found != seen.end()) {
          EXPECT_NEAR(found->enter_m, std::max(chord->enter, 0.0), 1e-9);
          EXPECT_NEAR(found->leave_m, std::min(chord->leave, max_m), 1e-9);
          ++matched;
        }
      }
      return true;
    });
    EXPECT_GT(matched, 5U);
    EXPECT_LE(seen.size(), matched + 1);  // one may be too short to tell
    for (std::size_t k = 1; k < seen.size(); ++k) {
      EXPECT_EQ(seen[k].enter_m, seen[k - 1].leave_m);
    }
  }
}

}  // namespace
}  // namespace skyhalo
