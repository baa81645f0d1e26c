#include "skyhalo/io/map_limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MapLimitsTest, MemoryGrowsWithBricksAndDoesNotOverflow) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  EXPECT_TRUE(fits_in_memory(0, 0, 0));
  EXPECT_FALSE(fits_in_memory(1, 0, 191));
  EXPECT_TRUE(fits_in_memory(1, 0, 192));
  EXPECT_FALSE(fits_in_memory(1, 1, 1231));
  EXPECT_TRUE(fits_in_memory(1, 1, 1232));
  EXPECT_FALSE(fits_in_memory(kMost, 0, kMost));
  EXPECT_FALSE(fits_in_memory(kMost, kMost, kMost));
  EXPECT_FALSE(fits_in_memory(0, kMost, kMost));
  EXPECT_FALSE(fits_in_memory(kMost / 192, 1, kMost - 191));
}

TEST(MapLimitsTest, LatticesOfTheUsualKindAreGood) {
  for (const double voxel_m : {1e-4, 0.05, 1.0, 1e4}) {
    EXPECT_THAT(lattice_fault({.origin_m = {1e9, -1e9, 0.0}, .voxel_m = voxel_m}), IsEmpty());
  }
}

TEST(MapLimitsTest, OthersAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double voxel_m : {0.0, -1.0, nan, 9e-5, 1.1e4}) {
    EXPECT_THAT(lattice_fault({.voxel_m = voxel_m}), HasSubstr("has cells of"));
  }
  for (const double x_m : {nan, 1.1e9, -1.1e9}) {
    EXPECT_THAT(lattice_fault({.origin_m = {0.0, 0.0, x_m}, .voxel_m = 1.0}), HasSubstr("origin"));
  }
}

}  // namespace
}  // namespace skyhalo
