#include "skyhalo/evaluation/comparison_picture.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace skyhalo {
namespace {

const cv::Vec3b kWhite(255, 255, 255);

VoxelGrid small_grid() {
  return {.min_m = {0.0, 0.0, 0.0}, .voxel_m = 1.0, .size = {4, 2, 2}};
}

std::int64_t offset(int x, int y, int z) {
  return small_grid().offset_of({x, y, z});
}

int lightness(const cv::Vec3b& colour) {
  return colour[0] + colour[1] + colour[2];
}

TEST(ComparisonPictureTest, TheTruthIsColouredByItsHighestCell) {
  GroundTruth truth(small_grid());
  truth.mark(std::vector<std::int64_t>{
      offset(0, 0, 0), offset(1, 0, 1), offset(2, 0, 0), offset(2, 0, 1), offset(3, 1, 0)});
  const cv::Mat3b picture = truth_picture(truth, 3);
  ASSERT_EQ(picture.size(), cv::Size(12, 6));
  const auto at = [&](int x, int y) { return picture(3 * (1 - y) + 1, 3 * x + 1); };
  EXPECT_NE(at(0, 0), at(1, 0));
  EXPECT_EQ(at(1, 0), at(2, 0));
  EXPECT_EQ(at(0, 0), at(3, 1));
  EXPECT_LT(lightness(at(0, 0)), lightness(at(1, 0)));  // low is dark
  EXPECT_EQ(at(0, 1), kWhite);
}

TEST(ComparisonPictureTest, ColumnsSayWhatBecameOfThem) {
  DenseMap map(small_grid());
  GroundTruth truth(small_grid());
  map.at(offset(0, 0, 1)) = 3000;  // found
  map.at(offset(1, 0, 0)) = 3000;  // only claimed
  map.at(offset(3, 0, 0)) = -3000;
  map.at(offset(0, 1, 0)) = 800;   // p = 0.69, claims nothing
  map.at(offset(1, 1, 0)) = 3000;  // found below a cell that is missed
  truth.mark(std::vector<std::int64_t>{
      offset(0, 0, 1), offset(2, 0, 0), offset(1, 1, 0), offset(1, 1, 1)});
  const cv::Mat3b picture = comparison_picture(map, truth, 0.7, 1);
  ASSERT_EQ(picture.size(), cv::Size(4, 2));
  const cv::Vec3b found = picture(1, 0);
  const cv::Vec3b claimed = picture(1, 1);
  const cv::Vec3b missed = picture(1, 2);
  EXPECT_GT(found[1], found[0]);  // green above all
  EXPECT_GT(found[1], found[2]);
  EXPECT_GT(claimed[2], claimed[1]);  // orange: red, then green, then blue
  EXPECT_GT(claimed[1], claimed[0]);
  EXPECT_GT(missed[0], missed[1]);  // blue above all
  EXPECT_GT(missed[0], missed[2]);
  EXPECT_EQ(picture(1, 3), kWhite);
  EXPECT_EQ(picture(0, 0), kWhite);
  EXPECT_EQ(picture(0, 1), found);
  EXPECT_EQ(picture(0, 3), kWhite);
}

TEST(ComparisonPictureTest, AnUnobservedCellClaimsNothing) {
  const cv::Mat3b picture =
      comparison_picture(DenseMap(small_grid()), GroundTruth(small_grid()), 0.4, 1);
  EXPECT_EQ(picture(0, 0), kWhite);
}

}  // namespace
}  // namespace skyhalo
