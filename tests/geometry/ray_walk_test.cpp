#include "skyhalo/geometry/ray_walk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "reference/naive_occupancy_map.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kSliverM = 1e-9;  // shorter chords are a matter of rounding

struct Crossing {
  Eigen::Vector3i cell;
  double enter_m = 0.0;
  double leave_m = 0.0;
};

/// 4 x 3 x 2 cells of 0.5 m from the origin.
VoxelGrid small_grid() {
  return make_voxel_grid({Eigen::Vector3d::Zero(), Eigen::Vector3d(2.0, 1.5, 1.0)}, 0.5);
}

std::vector<Crossing> walk(const VoxelGrid& grid, const Ray& ray) {
  std::vector<Crossing> crossings;
  walk_ray(grid, ray, [&](std::int64_t offset, double enter_m, double leave_m) {
    crossings.push_back({grid.cell_at(offset), enter_m, leave_m});
    return true;
  });
  return crossings;
}

std::vector<Eigen::Vector3i> cells(const VoxelGrid& grid, const Ray& ray) {
  std::vector<Eigen::Vector3i> result;
  for (const Crossing& crossing : walk(grid, ray)) {
    result.push_back(crossing.cell);
  }
  return result;
}

Eigen::Vector3i cell(int x, int y, int z) {
  return {x, y, z};
}

void expect_crossing(const Crossing& crossing,
                     const Eigen::Vector3i& expected_cell,
                     double enter_m,
                     double leave_m) {
  EXPECT_EQ(crossing.cell, expected_cell);
  EXPECT_NEAR(crossing.enter_m, enter_m, kSliverM);
  EXPECT_NEAR(crossing.leave_m, leave_m, kSliverM);
}

TEST(RayWalkTest, GoesAlongAnAxisFromCellToCell) {
  const std::vector<Crossing> seen = walk(small_grid(), {{0.2, 0.7, 0.3}, {1.0, 0.0, 0.0}});
  ASSERT_EQ(seen.size(), 4U);
  expect_crossing(seen[0], cell(0, 1, 0), 0.0, 0.3);
  expect_crossing(seen[1], cell(1, 1, 0), 0.3, 0.8);
  expect_crossing(seen[2], cell(2, 1, 0), 0.8, 1.3);
  expect_crossing(seen[3], cell(3, 1, 0), 1.3, 1.8);
}

TEST(RayWalkTest, GoesBackwardsToo) {
  const std::vector<Crossing> seen = walk(small_grid(), {{1.2, 0.7, 0.3}, {-1.0, 0.0, 0.0}});
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].cell, cell(2, 1, 0));
  EXPECT_EQ(seen[0].enter_m, 0.0);
  EXPECT_NEAR(seen[0].leave_m, 0.2, 1e-12);
  EXPECT_EQ(seen[2].cell, cell(0, 1, 0));
  EXPECT_NEAR(seen[2].enter_m, 0.7, 1e-12);
  EXPECT_NEAR(seen[2].leave_m, 1.2, 1e-12);
}

TEST(RayWalkTest, GoesUpAndDown) {
  EXPECT_THAT(cells(small_grid(), {{0.2, 0.7, 0.3}, {0.0, 0.0, 1.0}}),
              ElementsAre(cell(0, 1, 0), cell(0, 1, 1)));
  EXPECT_THAT(cells(small_grid(), {{0.2, 0.7, 0.8}, {0.0, 0.0, -1.0}}),
              ElementsAre(cell(0, 1, 1), cell(0, 1, 0)));
}

TEST(RayWalkTest, CrossesSlantwise) {
  // From (0.25, 0, 0.25) with slope 3/4 in y: x reaches 0.5 at s = 0.3125, y 0.5 at s = 0.8333,
  // x 1.0 at 0.9375, x 1.5 at 1.5625, y 1.0 at 1.6667, x 2.0 at 2.1875.
  const std::vector<Crossing> seen = walk(small_grid(), {{0.25, 0.0, 0.25}, {0.8, 0.6, 0.0}});
  const std::vector<Eigen::Vector3i> expected{
      cell(0, 0, 0), cell(1, 0, 0), cell(1, 1, 0), cell(2, 1, 0), cell(3, 1, 0), cell(3, 2, 0)};
  const std::vector<double> leave_m{0.3125, 2.5 / 3.0, 0.9375, 1.5625, 5.0 / 3.0, 2.1875};
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].cell, expected[i]);
    EXPECT_NEAR(seen[i].leave_m, leave_m[i], 1e-12);
  }
}

TEST(RayWalkTest, EntersFromOutside) {
  const std::vector<Crossing> seen = walk(small_grid(), {{-3.0, 0.7, 0.3}, {1.0, 0.0, 0.0}});
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[0].cell, cell(0, 1, 0));
  EXPECT_NEAR(seen[0].enter_m, 3.0, 1e-12);
  EXPECT_NEAR(seen[3].leave_m, 5.0, 1e-12);
}

TEST(RayWalkTest, EntersAtTheFarSide) {
  EXPECT_THAT(cells(small_grid(), {{9.0, 0.7, 0.3}, {-1.0, 0.0, 0.0}}),
              ElementsAre(cell(3, 1, 0), cell(2, 1, 0), cell(1, 1, 0), cell(0, 1, 0)));
}

TEST(RayWalkTest, MissesTheGrid) {
  EXPECT_THAT(walk(small_grid(), {{-3.0, 0.7, 0.3}, {-1.0, 0.0, 0.0}}), IsEmpty());  // away
  EXPECT_THAT(walk(small_grid(), {{-3.0, 1.7, 0.3}, {1.0, 0.0, 0.0}}), IsEmpty());   // beside
  EXPECT_THAT(walk(small_grid(), {{-3.0, 0.7, -0.1}, {1.0, 0.0, 0.0}}), IsEmpty());  // below
  EXPECT_THAT(walk(small_grid(), {{-3.0, 0.7, 0.3}, {0.6, 0.8, 0.0}}), IsEmpty());   // past
  EXPECT_THAT(walk(small_grid(), {{5.0, 5.0, 5.0}, {0.0, 0.0, 1.0}}), IsEmpty());
}

TEST(RayWalkTest, ARayInAFaceBelongsToTheUpperCell) {
  EXPECT_THAT(cells(small_grid(), {{0.2, 0.5, 0.3}, {1.0, 0.0, 0.0}}),
              ElementsAre(cell(0, 1, 0), cell(1, 1, 0), cell(2, 1, 0), cell(3, 1, 0)));
  EXPECT_THAT(cells(small_grid(), {{0.2, 0.5, 0.5}, {0.0, 1.0, -0.0}}),
              ElementsAre(cell(0, 1, 1), cell(0, 2, 1)));
}

TEST(RayWalkTest, TheLowerSidesOfTheGridBelongToItTheUpperOnesDoNot) {
  EXPECT_THAT(cells(small_grid(), {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}),
              ElementsAre(cell(0, 0, 0), cell(1, 0, 0), cell(2, 0, 0), cell(3, 0, 0)));
  EXPECT_THAT(walk(small_grid(), {{-1.0, 1.5, 0.0}, {1.0, 0.0, 0.0}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{-1.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}), IsEmpty());
}

TEST(RayWalkTest, StartsOnAFace) {
  EXPECT_THAT(cells(small_grid(), {{1.0, 0.7, 0.3}, {1.0, 0.0, 0.0}}),
              ElementsAre(cell(2, 1, 0), cell(3, 1, 0)));
  EXPECT_THAT(cells(small_grid(), {{1.0, 0.7, 0.3}, {-1.0, 0.0, 0.0}}),
              ElementsAre(cell(1, 1, 0), cell(0, 1, 0)));
  EXPECT_THAT(cells(small_grid(), {{2.0, 0.7, 0.3}, {-1.0, 0.0, 0.0}}),
              ElementsAre(cell(3, 1, 0), cell(2, 1, 0), cell(1, 1, 0), cell(0, 1, 0)));
  EXPECT_THAT(walk(small_grid(), {{2.0, 0.7, 0.3}, {1.0, 0.0, 0.0}}), IsEmpty());
}

TEST(RayWalkTest, ARayThroughEdgesVisitsNoCellOfNoLength) {
  // The diagonal of the x-y plane goes from edge to edge: only the cells on it have a length.
  const double s = std::sqrt(0.5);
  EXPECT_THAT(cells(small_grid(), {{0.0, 0.0, 0.25}, {s, s, 0.0}}),
              ElementsAre(cell(0, 0, 0), cell(1, 1, 0), cell(2, 2, 0)));
}

TEST(RayWalkTest, StopsWhenTold) {
  int visits = 0;
  walk_ray(small_grid(), {{0.2, 0.7, 0.3}, {1.0, 0.0, 0.0}}, [&](std::int64_t, double, double) {
    ++visits;
    return visits < 2;
  });
  EXPECT_EQ(visits, 2);
}

TEST(RayWalkTest, ARayWithoutDirectionVisitsNothing) {
  EXPECT_THAT(walk(small_grid(), {{0.2, 0.7, 0.3}, {0.0, 0.0, 0.0}}), ::testing::IsEmpty());
}

TEST(RayWalkTest, ARayThatIsNotFiniteVisitsNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(walk(small_grid(), {{kNan, 0.7, 0.3}, {1.0, 0.0, 0.0}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{0.2, kNan, 0.3}, {1.0, 0.0, 0.0}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{0.2, 0.7, kNan}, {0.6, 0.0, 0.8}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{0.2, 0.7, 0.3}, {kNan, 0.0, 0.0}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{0.2, 0.7, 0.3}, {0.6, 0.8, kNan}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{kNan, kNan, kNan}, {kNan, kNan, kNan}}), IsEmpty());
  EXPECT_THAT(walk(small_grid(), {{-kInf, 0.7, 0.3}, {1.0, 0.0, 0.0}}), IsEmpty());
}

TEST(RayWalkTest, ClipsToTheGrid) {
  const RayInterval inside = clip({{-3.0, 0.7, 0.3}, {1.0, 0.0, 0.0}}, small_grid());
  EXPECT_NEAR(inside.enter_m, 3.0, 1e-12);
  EXPECT_NEAR(inside.leave_m, 5.0, 1e-12);
  const RayInterval from_inside = clip({{0.5, 0.7, 0.3}, {-1.0, 0.0, 0.0}}, small_grid());
  EXPECT_EQ(from_inside.enter_m, 0.0);
  EXPECT_NEAR(from_inside.leave_m, 0.5, 1e-12);
  const RayInterval missed = clip({{-3.0, 1.7, 0.3}, {1.0, 0.0, 0.0}}, small_grid());
  EXPECT_LE(missed.leave_m, missed.enter_m);
  const RayInterval behind = clip({{-3.0, 0.7, 0.3}, {-1.0, 0.0, 0.0}}, small_grid());
  EXPECT_LE(behind.leave_m, behind.enter_m);
}

/// Rays of all kinds round and through a box of 6 x 5 x 4 m: from inside and outside, along one
/// axis or in one plane, nearly so, in every sense.
class RandomRays {
 public:
  explicit RandomRays(unsigned seed) : random_(seed) {}

  Ray next() {
    ++count_;
    Ray ray;
    const double reach = count_ % 2 == 0 ? 1.0 : 3.0;
    ray.origin_m = {reach * 3.0 * unit(), reach * 2.5 * unit(), reach * 2.0 * unit()};
    Eigen::Vector3d direction(unit(), unit(), unit());
    if (count_ % 5 == 0) {
      direction[count_ % 3] = 0.0;
    }
    if (count_ % 7 == 0) {
      direction[(count_ + 1) % 3] *= 1e-7;
    }
    if (count_ % 11 == 0) {
      direction = (unit() < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(count_ % 3);
    }
    ray.direction = direction.normalized();
    return ray;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  std::mt19937 random_;
  int count_ = 0;
};

VoxelGrid box_grid() {
  return make_voxel_grid({Eigen::Vector3d(-3.0, -2.5, -2.0), Eigen::Vector3d(3.0, 2.5, 2.0)}, 0.4);
}

/// The chords follow each other without a gap from where the ray enters the grid to where it leaves
/// it.
void expect_unbroken(const std::vector<Crossing>& seen, const RayInterval& inside) {
  double at_m = inside.enter_m;
  for (const Crossing& crossing : seen) {
    EXPECT_NEAR(crossing.enter_m, at_m, kSliverM);
    EXPECT_GT(crossing.leave_m, crossing.enter_m);
    at_m = crossing.leave_m;
  }
  EXPECT_NEAR(at_m, inside.leave_m, kSliverM);
}

TEST(RayWalkProperty, ChordsFollowEachOtherAndFillTheClippedLength) {
  const VoxelGrid grid = box_grid();
  RandomRays rays(63);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = rays.next();
    const RayInterval inside = clip(ray, grid);
    const std::vector<Crossing> seen = walk(grid, ray);
    const bool is_hit = inside.leave_m > inside.enter_m;
    EXPECT_EQ(seen.empty(), !is_hit);
    if (is_hit) {
      expect_unbroken(seen, inside);
      ++hits;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(RayWalkProperty, TheMiddleOfEveryChordLiesInItsCell) {
  const VoxelGrid grid = box_grid();
  RandomRays rays(64);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = rays.next();
    for (const Crossing& crossing : walk(grid, ray)) {
      if (crossing.leave_m - crossing.enter_m > kSliverM) {
        const double middle_m = (crossing.enter_m + crossing.leave_m) / 2.0;
        EXPECT_EQ(grid.cell_of(ray.origin_m + middle_m * ray.direction), crossing.cell);
      }
    }
  }
}

/// All chords by a slab test of every cell, slivers left out.
std::map<std::int64_t, reference::NaiveChord> chords_by_brute_force(const VoxelGrid& grid,
                                                                    const Ray& ray) {
  const reference::NaiveVoxelGrid naive_grid{{grid.min_m.x(), grid.min_m.y(), grid.min_m.z()},
                                             grid.voxel_m,
                                             {grid.size.x(), grid.size.y(), grid.size.z()}};
  const reference::NaiveRay naive_ray{{ray.origin_m.x(), ray.origin_m.y(), ray.origin_m.z()},
                                      {ray.direction.x(), ray.direction.y(), ray.direction.z()}};
  std::map<std::int64_t, reference::NaiveChord> chords;
  for (std::int64_t offset = 0; offset < grid.cell_count(); ++offset) {
    const Eigen::Vector3i at = grid.cell_at(offset);
    const auto chord = reference::naive_chord(naive_grid, {at.x(), at.y(), at.z()}, naive_ray);
    if (chord && chord->leave_m - chord->enter_m > kSliverM) {
      chords.emplace(offset, *chord);
    }
  }
  return chords;
}

/// True when the slab test gives the same chord. What has been compared is taken out of `expected`.
bool is_expected(const Crossing& crossing,
                 std::int64_t offset,
                 std::map<std::int64_t, reference::NaiveChord>& expected) {
  const auto chord = expected.find(offset);
  if (chord == expected.end()) {
    return crossing.leave_m - crossing.enter_m <= 2.0 * kSliverM;
  }
  const bool is_same = std::abs(crossing.enter_m - chord->second.enter_m) < kSliverM &&
                       std::abs(crossing.leave_m - chord->second.leave_m) < kSliverM;
  expected.erase(chord);
  return is_same;
}

void compare_with_brute_force(const VoxelGrid& grid, const Ray& ray) {
  std::map<std::int64_t, reference::NaiveChord> expected = chords_by_brute_force(grid, ray);
  for (const Crossing& crossing : walk(grid, ray)) {
    EXPECT_TRUE(is_expected(crossing, grid.offset_of(crossing.cell), expected))
        << "cell " << crossing.cell.transpose();
  }
  EXPECT_THAT(expected, IsEmpty())
      << ray.origin_m.transpose() << " to " << ray.direction.transpose();
}

TEST(RayWalkReference, VisitsExactlyTheCellsOfABruteForceSlabTest) {
  const VoxelGrid grid = box_grid();
  RandomRays rays(65);
  for (int i = 0; i < 800; ++i) {
    compare_with_brute_force(grid, rays.next());
  }
}

TEST(RayWalkReference, AgreesAlongFaces) {
  // Origins on the faces of cells of 0.5 m, which floating point holds exactly.
  const VoxelGrid grid = small_grid();
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 6 * 5 * 4; ++i) {
      const Eigen::Vector3i face(i % 6, i / 6 % 5, i / 30);
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d origin_m = 0.5 * face.cast<double>() - 0.25 * along;
      compare_with_brute_force(grid, {origin_m, along});
      compare_with_brute_force(grid, {origin_m, -along});
    }
  }
}

}  // namespace
}  // namespace skyhalo
