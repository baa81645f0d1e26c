#include "skyhalo/io/map_lattice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/map_cases.hpp"
#include "skyhalo/base/error.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

const VoxelLattice kLattice{.origin_m = {1.0, 2.0, 3.0}, .voxel_m = 0.5};

VoxelLattice at(double x_m, double y_m, double z_m, double voxel_m = 0.5) {
  return {.origin_m = {x_m, y_m, z_m}, .voxel_m = voxel_m};
}

TEST(MapLatticeTest, OriginsMayBeWholeCellsApart) {
  EXPECT_EQ(offset_to_same_cells(kLattice, kLattice), Eigen::Vector3i(0, 0, 0));
  EXPECT_EQ(offset_to_same_cells(kLattice, at(2.5, 2.0, -7.0)), Eigen::Vector3i(3, 0, -20));
  // Ten times 0.1 is not 1 in binary; a file may keep six digits of a third.
  EXPECT_EQ(offset_to_same_cells(at(0.0, 0.0, 0.0, 0.1), at(0.1 + 0.2, 0.0, 0.0, 0.1)),
            Eigen::Vector3i(3, 0, 0));
  EXPECT_EQ(offset_to_same_cells(at(0.0, 0.0, 0.0, 1.0 / 3.0), at(0.0, 0.0, 0.0, 0.333333)),
            Eigen::Vector3i(0, 0, 0));
}

TEST(MapLatticeTest, OtherCellsAreAnError) {
  EXPECT_THAT(message_of([] { (void)offset_to_same_cells(kLattice, at(1.0, 2.0, 3.0, 0.25)); }),
              HasSubstr("0.5 m and 0.25 m"));
  EXPECT_THAT(message_of([] { (void)offset_to_same_cells(kLattice, at(1.25, 2.0, 3.0)); }),
              HasSubstr("(0.5, 0, 0) cells apart"));
  EXPECT_THAT(message_of([] { (void)offset_to_same_cells(kLattice, at(1e12, 2.0, 3.0)); }),
              HasSubstr("too far apart"));
}

TEST(MapLatticeTest, MovedCellsKeepTheirValues) {
  const SparseMap map = testing::random_map(1, 30, 2);
  for (const Eigen::Vector3i& offset :
       {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(8, -16, 80), Eigen::Vector3i(1, -3, 13)}) {
    SCOPED_TRACE(offset.transpose());
    const SparseMap result = moved_to(map, kLattice, offset);
    EXPECT_EQ(result.lattice(), kLattice);
    for (int x = -30; x < 30; ++x) {
      for (int y = -30; y < 30; ++y) {
        for (int z = -30; z < 30; ++z) {
          ASSERT_EQ(result.at(Eigen::Vector3i(x, y, z) + offset), map.at({x, y, z}));
        }
      }
    }
  }
}

TEST(MapLatticeTest, UniformBricksStayUniformWhereTheyCan) {
  SparseMap map(kLattice);
  for (int z = 0; z < 4; ++z) {
    map.set_uniform({0, 0, z}, -700);
  }
  EXPECT_EQ(moved_to(map, kLattice, {8, 0, 0}).uniform({1, 0, 3}), LogOdds{-700});
  const SparseMap result = moved_to(map, kLattice, {0, 0, 3});
  EXPECT_EQ(result.brick_count(), 5U);
  EXPECT_EQ(result.uniform({0, 0, 2}), LogOdds{-700});
  EXPECT_EQ(result.uniform({0, 0, 0}), std::nullopt);
  EXPECT_EQ(result.uniform({0, 0, 4}), std::nullopt);
}

TEST(MapLatticeTest, CellsMayGoToTheLastNumberAndNoFurther) {
  constexpr int kLast = VoxelLattice::kReach - 1;
  SparseMap map(kLattice);
  map.set({0, 0, 0}, 100);
  EXPECT_EQ(moved_to(map, kLattice, {kLast, 0, -kLast - 1}).at({kLast, 0, -kLast - 1}), 100);
  EXPECT_FALSE(moved(map, kLattice, {kLast + 1, 0, 0}));
  EXPECT_FALSE(moved(map, kLattice, {0, 0, -kLast - 2}));
  EXPECT_THAT(message_of([&] {
                (void)moved_to(map, kLattice, {kLast + 1, 0, 0});
              }),
              HasSubstr("too far apart"));
}

}  // namespace
}  // namespace skyhalo
