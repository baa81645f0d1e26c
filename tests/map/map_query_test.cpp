#include "skyhalo/map/map_query.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/random_maps.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

using reference::NaiveAnswer;
using reference::NaiveCell;
using ::testing::Each;
using ::testing::Gt;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 8 x 4 x 4 cells of 0.5 m from the origin, all free but the one at (5, 1, 1).
DenseMap box_with_one_thing() {
  DenseMap map(VoxelGrid{Eigen::Vector3d::Zero(), 0.5, {8, 4, 4}});
  for_each_cell(map.bounds(), [&map](const Eigen::Vector3i& cell) {
    map.set(cell, -500);
    return true;
  });
  map.set({5, 1, 1}, 847);
  return map;
}

TEST(MapQueryTest, GivesTheProbabilityAtAPoint) {
  const DenseMap map = box_with_one_thing();
  EXPECT_NEAR(probability(map, {2.6, 0.6, 0.9}), 0.69993, 1e-5);  // 1 / (1 + e^-0.847)
  EXPECT_NEAR(probability(map, {0.1, 0.1, 0.1}), 0.37754, 1e-5);
  EXPECT_EQ(probability(map, {-0.1, 0.1, 0.1}), 0.5);
  EXPECT_EQ(probability(map, {kNan, 0.1, 0.1}), 0.5);
}

TEST(MapQueryTest, TellsFreeOccupiedAndUnknownPoints) {
  const DenseMap map = box_with_one_thing();
  EXPECT_EQ(occupancy(map, Eigen::Vector3d(2.5, 0.5, 0.5)), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, Eigen::Vector3d(3.0, 0.5, 0.5)), Occupancy::kFree);  // the next cell
  EXPECT_EQ(occupancy(map, Eigen::Vector3d(4.0, 0.5, 0.5)), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, Eigen::Vector3d(0.0, kInfinity, 0.0)), Occupancy::kNotKnown);
}

TEST(MapQueryTest, FollowsTheRule) {
  const DenseMap map = box_with_one_thing();
  const Eigen::Vector3d thing_m(2.6, 0.6, 0.6);
  const Eigen::Vector3d beside_m(0.1, 0.1, 0.1);
  EXPECT_EQ(occupancy(map, thing_m, {847, 0}), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, thing_m, {846, 0}), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, beside_m, {0, -500}), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, beside_m, {0, -499}), Occupancy::kFree);
  EXPECT_EQ(occupancy(map, thing_m, {1000, 900}), Occupancy::kFree);
}

TEST(MapQueryTest, DoesNotTakeAFarPointForTheOutermostCell) {
  SparseMap map(VoxelLattice{});
  map.set(Eigen::Vector3i::Constant(VoxelLattice::kReach - 1), 500);
  const Eigen::Vector3d outermost_m = Eigen::Vector3d::Constant(VoxelLattice::kReach - 0.5);
  EXPECT_EQ(occupancy(map, outermost_m), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, Eigen::Vector3d(outermost_m.array() + 1.0)), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, Eigen::Vector3d::Constant(kNan)), Occupancy::kNotKnown);
  map.set(Eigen::Vector3i::Constant(VoxelLattice::kReach - 1), -500);
  EXPECT_EQ(occupancy(map, Eigen::AlignedBox3d(outermost_m, outermost_m)), Occupancy::kFree);
  EXPECT_EQ(occupancy(map, Eigen::AlignedBox3d(outermost_m, outermost_m.array() + 1.0)),
            Occupancy::kNotKnown);
}

TEST(MapQueryTest, TakesABoxTogether) {
  const DenseMap map = box_with_one_thing();
  const auto of = [&map](const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m) {
    return occupancy(map, Eigen::AlignedBox3d(min_m, max_m));
  };
  EXPECT_EQ(of({0.0, 0.0, 0.0}, {2.4, 1.9, 1.9}), Occupancy::kFree);
  EXPECT_EQ(of({0.0, 0.0, 0.0}, {2.5, 1.9, 1.9}), Occupancy::kOccupied);  // sides belong to it
  EXPECT_EQ(of({-0.1, 0.0, 0.0}, {2.4, 1.9, 1.9}), Occupancy::kNotKnown);
  EXPECT_EQ(of({-9.0, -9.0, -9.0}, {9.0, 9.0, 9.0}), Occupancy::kOccupied);
  EXPECT_EQ(of({0.2, 0.2, 0.2}, {0.2, 0.2, 0.2}), Occupancy::kFree);
  EXPECT_EQ(of({0.3, 0.2, 0.2}, {0.2, 0.4, 0.4}), Occupancy::kNotKnown);  // empty
  EXPECT_EQ(of({0.2, kNan, 0.2}, {0.3, 0.4, 0.4}), Occupancy::kNotKnown);
  EXPECT_EQ(of({0.2, 0.2, 0.2}, {0.3, 0.4, kInfinity}), Occupancy::kNotKnown);
}

TEST(MapQueryTest, TakesASegmentTogether) {
  const DenseMap map = box_with_one_thing();
  const auto of = [&map](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    return occupancy(map, Segment{from_m, to_m});
  };
  EXPECT_EQ(of({0.2, 0.7, 0.7}, {2.4, 0.7, 0.7}), Occupancy::kFree);
  EXPECT_EQ(of({0.2, 0.7, 0.7}, {2.6, 0.7, 0.7}), Occupancy::kOccupied);
  EXPECT_EQ(of({3.9, 0.7, 0.7}, {2.9, 0.7, 0.7}), Occupancy::kOccupied);
  EXPECT_EQ(of({0.2, 1.2, 0.7}, {3.9, 1.2, 0.7}), Occupancy::kFree);  // beside it
  EXPECT_EQ(of({-2.0, 1.2, 0.7}, {3.9, 1.2, 0.7}), Occupancy::kNotKnown);
  EXPECT_EQ(of({-2.0, 0.7, 0.7}, {9.0, 0.7, 0.7}), Occupancy::kOccupied);
  EXPECT_EQ(of({0.2, 0.2, 0.2}, {0.2, 0.2, 0.2}), Occupancy::kFree);  // a point
  EXPECT_EQ(of({2.6, 0.7, 0.7}, {2.6, 0.7, 0.7}), Occupancy::kOccupied);
  EXPECT_EQ(of({0.2, 0.7, 0.7}, {2.6, kNan, 0.7}), Occupancy::kNotKnown);
}

TEST(MapQueryTest, TakesACapsuleTogether) {
  const DenseMap map = box_with_one_thing();
  // The thing's cube begins at y = 0.5; the axis runs 0.3 m below that.
  const Segment axis{{1.0, 0.2, 0.75}, {3.5, 0.2, 0.75}};
  EXPECT_EQ(occupancy(map, Capsule{axis, 0.1}), Occupancy::kFree);
  EXPECT_EQ(occupancy(map, Capsule{axis, 0.25}), Occupancy::kNotKnown);  // below the map
  EXPECT_EQ(occupancy(map, Capsule{axis, 0.31}), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, Capsule{axis, -0.1}), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, Capsule{axis, kNan}), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, Capsule{{{1.0, kNan, 0.75}, {3.5, 0.2, 0.75}}, 0.1}),
            Occupancy::kNotKnown);
}

TEST(MapQueryTest, ComesToAnEndOnAMapWithoutBounds) {
  SparseMap map(VoxelLattice{Eigen::Vector3d::Zero(), 0.1});
  map.set({1000000, 20, 30}, 500);
  map.set({-1000000, 20, 30}, -500);
  const Eigen::Vector3d far_m(1.5e6, 1.5e6, 1.5e6);
  const Segment line{{-1.5e6, 2.05, 3.05}, {1.5e6, 2.05, 3.05}};
  EXPECT_EQ(occupancy(map, Eigen::AlignedBox3d(-far_m, far_m)), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, line), Occupancy::kOccupied);
  EXPECT_EQ(occupancy(map, Capsule{line, 1e5}), Occupancy::kOccupied);
  map.set({1000000, 20, 30}, -500);
  EXPECT_EQ(occupancy(map, Eigen::AlignedBox3d(-far_m, far_m)), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, line), Occupancy::kNotKnown);
  EXPECT_EQ(occupancy(map, Capsule{line, 1e5}), Occupancy::kNotKnown);
}

/// How often each answer came, so that a test knows that it saw all.
struct Tally {
  std::array<int, 3> counts{};

  void add(Occupancy answer) { ++counts.at(static_cast<std::size_t>(answer)); }
};

Occupancy from(NaiveAnswer answer) {
  if (answer == NaiveAnswer::kOccupied) {
    return Occupancy::kOccupied;
  }
  return answer == NaiveAnswer::kFree ? Occupancy::kFree : Occupancy::kNotKnown;
}

/// A random map, and a random way in it: mostly short, so that all answers come.
template <class Map>
struct Trial {
  const Map& map;
  std::vector<NaiveCell> cells;
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
};

/// Compares `ask(trial)` with `naive(trial)` on maps of few things and of many.
template <class Ask, class Naive>
void compare(const Ask& ask, const Naive& naive) {
  const auto use = [&](const auto& map, unsigned seed) {
    const CellBox region = testing::known_and_rim(map);
    Trial<std::decay_t<decltype(map)>> trial{map, testing::cells_in(map, region), {}, {}};
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Tally tally;
    for (int i = 0; i < 240; ++i) {
      trial.from_m = testing::random_point(map.lattice(), region, rng);
      if (i % 12 == 0) {  // a thing is too rare to be met by chance
        const auto from =
            trial.cells.begin() + (i / 12) * (trial.cells.end() - trial.cells.begin()) / 20;
        const auto thing = std::find_if(
            from, trial.cells.end(), [](const NaiveCell& cell) { return cell.log_odds > 100; });
        trial.from_m =
            thing == trial.cells.end() ? trial.from_m : thing->min_m.array() + 0.3 * thing->voxel_m;
      }
      const Eigen::Vector3d to_m = testing::random_point(map.lattice(), region, rng);
      trial.to_m = trial.from_m + std::pow(share(rng), 3.0) * (to_m - trial.from_m);
      const Occupancy answer = ask(trial);
      EXPECT_EQ(answer, naive(trial));
      tally.add(answer);
    }
    EXPECT_THAT(tally.counts, Each(Gt(4)));
  };
  for (unsigned seed = 1; seed <= static_cast<unsigned>(testing::rounds(2)); ++seed) {
    const double occupied = seed == 1 ? 0.02 : 0.2;
    use(testing::random_dense_map(occupied, seed), seed);
    use(testing::random_local_map(occupied, seed), seed);
    use(testing::random_sparse_map(occupied, seed), seed);
  }
}

constexpr OccupancyRule kRule{100, -100};

/// The cells for which `belongs` holds, together.
template <class Belongs>
Occupancy naive(const std::vector<NaiveCell>& cells, const Belongs& belongs) {
  std::vector<NaiveAnswer> answers;
  for (const NaiveCell& cell : cells) {
    if (belongs(cell)) {
      answers.push_back(naive_answer(cell, kRule.occupied_above, kRule.free_below));
    }
  }
  return from(naive_together(answers));
}

bool holds(const NaiveCell& cell, const Eigen::Vector3d& point_m) {
  return (point_m.array() >= cell.min_m.array()).all() &&
         (point_m.array() < cell.min_m.array() + cell.voxel_m).all();
}

/// True when a cell, its faces left out, has a point of the box (m).
bool meets(const NaiveCell& cell, const Eigen::AlignedBox3d& box_m) {
  return (box_m.max().array() >= cell.min_m.array()).all() &&
         (box_m.min().array() < cell.min_m.array() + cell.voxel_m).all();
}

Eigen::AlignedBox3d box_between(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m) {
  return {a_m.cwiseMin(b_m), a_m.cwiseMax(b_m)};
}

TEST(MapQueryReference, PointsAreAsTheirCells) {
  compare([](const auto& trial) { return occupancy(trial.map, trial.from_m, kRule); },
          [](const auto& trial) {
            return naive(trial.cells,
                         [&](const NaiveCell& cell) { return holds(cell, trial.from_m); });
          });
}

TEST(MapQueryReference, BoxesAreAsTheirCells) {
  compare(
      [](const auto& trial) {
        return occupancy(trial.map, box_between(trial.from_m, trial.to_m), kRule);
      },
      [](const auto& trial) {
        return naive(trial.cells, [&](const NaiveCell& cell) {
          return meets(cell, box_between(trial.from_m, trial.to_m));
        });
      });
}

TEST(MapQueryReference, SegmentsAreAsTheirCells) {
  compare(
      [](const auto& trial) {
        return occupancy(trial.map, Segment{trial.from_m, trial.to_m}, kRule);
      },
      [](const auto& trial) {
        return naive(trial.cells, [&](const NaiveCell& cell) {
          const auto part = naive_stretch(cell, trial.from_m, trial.to_m - trial.from_m);
          return holds(cell, trial.from_m) || holds(cell, trial.to_m) ||
                 (part && std::min(part->leave, 1.0) > std::max(part->enter, 0.0) + 1e-12);
        });
      });
}

TEST(MapQueryReference, CapsulesAreAsTheirCells) {
  const double radius_m = 0.37;
  compare(
      [&](const auto& trial) {
        return occupancy(trial.map, Capsule{{trial.from_m, trial.to_m}, radius_m}, kRule);
      },
      [&](const auto& trial) {
        Eigen::AlignedBox3d about_m = box_between(trial.from_m, trial.to_m);
        about_m.extend(about_m.min() - Eigen::Vector3d::Constant(radius_m));
        about_m.extend(about_m.max() + Eigen::Vector3d::Constant(radius_m));
        return naive(trial.cells, [&](const NaiveCell& cell) {
          return meets(cell, about_m) &&
                 naive_segment_distance_m(cell, trial.from_m, trial.to_m) <= radius_m;
        });
      });
}

}  // namespace
}  // namespace skyhalo
