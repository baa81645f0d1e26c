#include "skyhalo/io/map_slice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/map_points.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

const OccupancyRule kRule = rule_of(0.7);

/// Cells of half a metre; cell (0, 0, 0) begins at (10, -1, 0).
SparseMap half_metre_map() {
  return SparseMap({.origin_m = {10.0, -1.0, 0.0}, .voxel_m = 0.5});
}

TEST(MapSliceTest, ColumnsAreOccupiedFreeOrUnknown) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, -2000);
  map.set({0, 0, 1}, 2000);
  map.set({1, 0, 0}, -2000);
  map.set({1, 0, 1}, 300);  // seen, but of no clear opinion
  map.set({2, 0, 0}, 300);
  map.set({2, 1, 1}, 2000);
  map.set({2, 1, 0}, -2000);
  const MapSlice slice = slice_of(map, {0.0, 1.0}, kRule);
  ASSERT_EQ(slice.image.size(), cv::Size(3, 2));
  // The lower row is y = 0.
  EXPECT_EQ(slice.image(1, 0), 0);
  EXPECT_EQ(slice.image(1, 1), 254);
  EXPECT_EQ(slice.image(1, 2), 205);
  EXPECT_EQ(slice.image(0, 0), 205);
  EXPECT_EQ(slice.image(0, 2), 0);
  EXPECT_EQ(slice.corner_m, Eigen::Vector2d(10.0, -1.0));
  EXPECT_EQ(slice.voxel_m, 0.5);
}

TEST(MapSliceTest, OnlyCellsThatReachIntoTheHeightsCount) {
  SparseMap map = half_metre_map();
  for (int z = -3; z < 3; ++z) {
    map.set({z, z, z}, -2000);
  }
  const auto columns = [&](double low_m, double high_m) {
    return slice_of(map, {low_m, high_m}, kRule).image.cols;
  };
  EXPECT_EQ(columns(-1.5, 1.5), 6);
  EXPECT_EQ(columns(-100.0, 100.0), 6);
  EXPECT_EQ(columns(0.0, 0.5), 1) << "cells 1 and -1 only touch it";
  EXPECT_EQ(columns(0.0, 0.51), 2);
  EXPECT_EQ(columns(-0.01, 0.5), 2);
  EXPECT_EQ(columns(0.7, 0.7), 1);
  EXPECT_EQ(columns(0.5, 0.5), 1);
  EXPECT_EQ(slice_of(map, {0.5, 0.5}, kRule).corner_m, Eigen::Vector2d(10.5, -0.5));
  // Three times 0.1 is a little more than 0.3.
  SparseMap tenths({.voxel_m = 0.1});
  tenths.set({0, 0, 2}, -2000);
  tenths.set({1, 0, 3}, -2000);
  EXPECT_EQ(slice_of(tenths, {0.0, 3 * 0.1}, kRule).image.cols, 1);
}

TEST(MapSliceTest, UniformBricksFillTheirColumns) {
  SparseMap map = half_metre_map();
  map.set_uniform({-1, 0, 0}, -2000);
  map.set({0, 3, 9}, 2000);  // above the heights
  map.set({3, 9, 4}, 2000);
  const MapSlice slice = slice_of(map, {1.0, 2.5}, kRule);
  ASSERT_EQ(slice.image.size(), cv::Size(12, 10));
  EXPECT_EQ(cv::countNonZero(slice.image == 254), 64);
  EXPECT_EQ(cv::countNonZero(slice.image == 0), 1);
  EXPECT_EQ(slice.image(0, 11), 0);
  EXPECT_EQ(slice.corner_m, Eigen::Vector2d(6.0, -1.0));
}

TEST(MapSliceTest, NothingKnownIsAnError) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, 1000);
  EXPECT_THAT(message_of([&] {
                (void)slice_of(map, {0.5, 2.0}, kRule);
              }),
              HasSubstr("0.5 m and 2 m"));
  EXPECT_THAT(message_of([&] {
                (void)slice_of(half_metre_map(), {-1e300, 1e300}, kRule);
              }),
              HasSubstr("nothing of the map is known"));
}

TEST(MapSliceTest, APictureThatIsTooLargeIsAFailure) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, 1000);
  map.set({1'000'000, 1'000'000, 0}, 1000);
  EXPECT_THAT(message_of(
                  [&] {
                    (void)slice_of(map, {0.0, 0.5}, kRule);
                  },
                  ErrorKind::kFailure),
              HasSubstr("1000001 x 1000001 pixels"));
}

/// The value of a key in the YAML text.
std::string value_of(const std::vector<std::string>& lines, const std::string& key) {
  for (const std::string& line : lines) {
    if (line.starts_with(key + ": ")) {
      return line.substr(key.size() + 2);
    }
  }
  return "";
}

TEST(MapSliceTest, MapServerSeesTheSame) {
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, -2000);
  map.set({1, 0, 0}, 2000);
  map.set({3, 0, 0}, -2000);
  const TempFolder folder;
  write_slice(folder.path() / "floor plan.png", slice_of(map, {0.0, 0.5}, kRule));
  const cv::Mat image = read_image(folder.path() / "floor plan.png");
  const std::vector<std::string> lines = read_lines(folder.path() / "floor plan.yaml");
  EXPECT_EQ(value_of(lines, "image"), "\"floor plan.png\"");
  EXPECT_EQ(value_of(lines, "resolution"), "0.5");
  EXPECT_EQ(value_of(lines, "origin"), "[10, -1, 0]");
  EXPECT_EQ(value_of(lines, "negate"), "0");
  EXPECT_EQ(value_of(lines, "mode"), "trinary");
  const double occupied = parse_number(value_of(lines, "occupied_thresh")).value_or(-1.0);
  const double free = parse_number(value_of(lines, "free_thresh")).value_or(-1.0);
  // What map_server does with `negate: 0`: darker is more occupied.
  std::string seen;
  ASSERT_EQ(image.type(), CV_8UC1);
  for (int x = 0; x < image.cols; ++x) {
    const double p = (255 - image.at<unsigned char>(0, x)) / 255.0;
    seen += p > occupied ? 'x' : p < free ? '.' : '?';
  }
  EXPECT_EQ(seen, ".x?.");
}

TEST(MapSliceTest, AFolderThatIsMissingIsAFailure) {
  const TempFolder folder;
  SparseMap map = half_metre_map();
  map.set({0, 0, 0}, -2000);
  const auto file = folder.path() / "none" / "map.png";
  EXPECT_THAT(message_of(
                  [&] {
                    write_slice(file, slice_of(map, {0.0, 0.5}, kRule));
                  },
                  ErrorKind::kFailure),
              HasSubstr(file.string()));
}

}  // namespace
}  // namespace skyhalo
