#include "skyhalo/io/map_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "skyhalo/io/pcd.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TempFolder;

SparseMap half_metre_map() {
  return SparseMap({.origin_m = {10.0, -1.0, 0.0}, .voxel_m = 0.5});
}

TEST(MapPointsTest, TheRuleIsThatOfTheProbability) {
  for (const double probability : {0.5, 0.7, 0.9}) {
    const OccupancyRule rule = rule_of(probability);
    for (int units = -3000; units <= 3000; ++units) {
      const double p = 1.0 / (1.0 + std::exp(-0.001 * units));
      const Occupancy state = rule(static_cast<LogOdds>(units));
      ASSERT_EQ(state == Occupancy::kOccupied, p > probability) << units;
      ASSERT_EQ(state == Occupancy::kFree, p < 0.5) << units;
    }
  }
  EXPECT_LE(rule_of(0.2).free_below, rule_of(0.2).occupied_above);
}

TEST(MapPointsTest, PointsAreTheCentresOfOccupiedCells) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, 900);
  map.set({0, 0, 1}, 800);  // p = 0.69
  map.set({-1, 3, 0}, -3000);
  map.set({3, -2, 5}, 5000);
  const std::vector<OccupiedPoint> points = occupied_points(map, rule_of(0.7));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].center_m, Eigen::Vector3f(11.75F, -1.75F, 2.75F)) << "brick (0, -1, 0)";
  EXPECT_NEAR(points[0].probability, 0.9933, 1e-4);
  EXPECT_EQ(points[1].center_m, Eigen::Vector3f(10.25F, -0.75F, 0.25F));
  EXPECT_NEAR(points[1].probability, 0.7109, 1e-4);
}

TEST(MapPointsTest, UniformBricksAreAllTheirCells) {
  SparseMap map = half_metre_map();
  map.set_uniform({0, 0, 0}, 2000);
  map.set_uniform({1, 0, 0}, -2000);
  EXPECT_EQ(occupied_points(map, rule_of(0.7)).size(), 512U);
}

TEST(MapPointsTest, TooManyPointsAreAFailure) {
  SparseMap map = half_metre_map();
  for (int i = 0; i <= 262'144; ++i) {  // 2^18 bricks are 2^27 cells
    map.set_uniform({i % 64, i / 64 % 64, i / 4096}, 2000);
  }
  EXPECT_THAT(message_of([&] { (void)occupied_points(map, rule_of(0.7)); }, ErrorKind::kFailure),
              HasSubstr("134218240 occupied cells"));
}

TEST(MapPointsTest, ColoursGoByHeight) {
  const std::vector<ColouredPoint> points =
      coloured_by_height({{{0, 0, 1}, 1}, {{5, 0, 3}, 1}, {{0, 0, 2}, 1}, {{9, 9, 1}, 1}});
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0].colour_bgr, points[3].colour_bgr);
  EXPECT_NE(points[0].colour_bgr, points[1].colour_bgr);
  EXPECT_NE(points[0].colour_bgr, points[2].colour_bgr);
  EXPECT_EQ(points[1].position_m, Eigen::Vector3f(5, 0, 3));
  EXPECT_THAT(coloured_by_height({}), IsEmpty());
  EXPECT_EQ(coloured_by_height({{{0, 0, 1}, 1}}).size(), 1U);
}

TEST(PcdTest, TheFileIsAsThePointCloudLibraryDescribesIt) {
  const TempFolder folder;
  const auto file = folder.path() / "map.pcd";
  write_pcd(file, {{{1.0F, -2.0F, 0.5F}, 0.75F}, {{0.0F, 0.0F, 0.0F}, 1.0F}});
  // 1, -2, 0.5, 0.75 and 1 as IEEE 754 single precision.
  const std::string data(
      "\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f\0\0\x40\x3f"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f",
      32);
  EXPECT_EQ(read_bytes(file),
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\n"
            "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
            "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n" +
                data);
}

TEST(PcdTest, AFileThatCannotBeWrittenIsAFailure) {
  const TempFolder folder;
  const auto file = folder.path() / "none" / "map.pcd";
  EXPECT_THAT(message_of([&] { write_pcd(file, {}); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
}

}  // namespace
}  // namespace skyhalo
