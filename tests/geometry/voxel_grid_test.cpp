#include "skyhalo/geometry/voxel_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

Eigen::AlignedBox3d box(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m) {
  return {min_m, max_m};
}

TEST(VoxelGridTest, HasTheCellsOfTheThesisReferenceFigure) {
  // METHOD 6: 100 x 40 x 10 m at 0.5 m is 320 000 cells.
  const VoxelGrid grid = make_voxel_grid(box({0, -20, -5}, {100, 20, 5}), 0.5);
  EXPECT_EQ(grid.size, Eigen::Vector3i(200, 80, 20));
  EXPECT_EQ(grid.cell_count(), 320000);
}

TEST(VoxelGridTest, CellsAreHalfOpen) {
  const VoxelGrid grid = make_voxel_grid(box({-1, -1, -1}, {1, 1, 1}), 0.5);
  EXPECT_EQ(grid.cell_of({-1.0, -0.5, 0.999}), Eigen::Vector3i(0, 1, 3));
  EXPECT_TRUE(grid.holds(grid.cell_of({-1.0, -1.0, -1.0})));
  EXPECT_FALSE(grid.holds(grid.cell_of({0.0, 1.0, 0.0})));
  EXPECT_FALSE(grid.holds(grid.cell_of({0.0, -1.001, 0.0})));
}

TEST(VoxelGridTest, APointThatIsNotFiniteIsOutside) {
  const VoxelGrid grid = make_voxel_grid(box({-1, -1, -1}, {1, 1, 1}), 0.5);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(grid.holds(grid.cell_of({kNan, 0.0, 0.0})));
  EXPECT_FALSE(grid.holds(grid.cell_of({0.0, 1e300, 0.0})));
  EXPECT_FALSE(grid.holds(grid.cell_of({0.0, 0.0, -1e300})));
}

TEST(VoxelGridTest, ALengthThatIsNoWholeNumberOfVoxelsGrows) {
  const VoxelGrid grid = make_voxel_grid(box({0, 0, 0}, {1.0, 1.1, 0.3}), 0.1);
  EXPECT_EQ(grid.size,
            Eigen::Vector3i(10, 11, 3));  // 1.1 / 0.1 is slightly above 11 in floating point
  EXPECT_EQ(make_voxel_grid(box({0, 0, 0}, {1, 1, 1}), 0.3).size, Eigen::Vector3i(4, 4, 4));
}

TEST(VoxelGridTest, AVoxelLargerThanTheBoundsIsOneCell) {
  EXPECT_EQ(make_voxel_grid(box({0, 0, 0}, {1, 1, 1}), 1e9).size, Eigen::Vector3i(1, 1, 1));
}

TEST(VoxelGridTest, RefusesBoundsThatAreNone) {
  EXPECT_THAT(message_of([] {
                (void)make_voxel_grid(box({0, 5, 0}, {1, -5, 1}), 0.5);
              }),
              ::testing::HasSubstr("y runs from 5 to -5"));
  EXPECT_THAT(message_of([] {
                (void)make_voxel_grid(box({0, 0, 0}, {1, 1, 1}), 0.0);
              }),
              ::testing::HasSubstr("voxel"));
  EXPECT_THAT(message_of([] {
                (void)make_voxel_grid(box({0, 0, 0}, {1e5, 1e5, 1e5}), 0.1);
              }),
              ::testing::HasSubstr("2^31"));
}

TEST(VoxelGridProperty, OffsetAndCellAreInverse) {
  const VoxelGrid grid = make_voxel_grid(box({-1, -2, -3}, {1, 2, 3}), 0.5);
  for (std::int64_t offset = 0; offset < grid.cell_count(); ++offset) {
    const Eigen::Vector3i cell = grid.cell_at(offset);
    EXPECT_EQ(grid.offset_of(cell), offset);
    EXPECT_EQ(grid.cell_of(grid.center_m(cell)), cell);
  }
}

}  // namespace
}  // namespace skyhalo
