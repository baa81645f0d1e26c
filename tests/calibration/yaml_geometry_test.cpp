#include "skyhalo/calibration/yaml_geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::expect_matrix;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

YamlValue value_of(const TempFolder& folder, const std::string& text) {
  return YamlValue::load(folder.write("a.yaml", text)).at("v");
}

TEST(YamlGeometryTest, AMatrixComesAsRowsOrAsData) {
  const TempFolder folder;
  EXPECT_THAT(matrix_numbers(value_of(folder, "v:\n- [1, 2]\n- [3, 4]\n")),
              ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(matrix_numbers(value_of(folder, "v: {rows: 2, cols: 2, data: [1, 2, 3, 4]}\n")),
              ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(matrix_numbers(value_of(folder,
                                      "v: !!opencv-matrix\n   rows: 1\n   cols: 2\n   dt: d\n"
                                      "   data: [ 1., 2.5e+00 ]\n")),
              ElementsAre(1, 2.5));
}

TEST(YamlGeometryTest, RowsAndColsMustFitTheData) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] {
                (void)matrix_numbers(value_of(folder, "v: {rows: 2, cols: 2, data: [1, 2, 3]}\n"));
              }),
              AllOf(HasSubstr("a.yaml:1:"), HasSubstr("v.data: expected 2 x 2 numbers, found 3")));
  EXPECT_THAT(message_of([&] {
                (void)matrix_numbers(value_of(folder, "v: {rows: -1, cols: -1, data: [1]}\n"));
              }),
              HasSubstr("v.rows"));
  EXPECT_THAT(
      message_of([&] { (void)matrix_numbers(value_of(folder, "v: {rows: 1, cols: 1}\n")); }),
      HasSubstr("v.data: this key is missing"));
}

TEST(YamlGeometryTest, APoseIsA4x4Matrix) {
  const TempFolder folder;
  std::vector<std::string> warnings;
  const Pose T = read_pose(
      value_of(folder, "v: [[0, -1, 0, 4], [1, 0, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]]\n"), warnings);
  expect_matrix(T * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(4, 6, 6));
  EXPECT_THAT(
      message_of([&] { (void)read_pose(value_of(folder, "\nv: [[1, 0], [0, 1]]\n"), warnings); }),
      HasSubstr("a.yaml:2: v: expected 16 numbers, found 4"));
}

TEST(YamlGeometryTest, ASizeIsTwoWholeNumbersAboveZero) {
  const TempFolder folder;
  EXPECT_EQ(read_size_px(value_of(folder, "v: [752, 480]\n")), cv::Size(752, 480));
  for (const std::string bad :
       {"[752]", "[752, 480, 1]", "[752, 0]", "[-752, 480]", "[7.5, 1]", "[16385, 1]"}) {
    SCOPED_TRACE(bad);
    EXPECT_THAT(message_of([&] { (void)read_size_px(value_of(folder, "v: " + bad + "\n")); }),
                HasSubstr("a.yaml:1: v"));
  }
}

TEST(YamlGeometryTest, IntrinsicsAreFourNumbers) {
  const TempFolder folder;
  const Intrinsics k = read_intrinsics(value_of(folder, "v: [400, 401, 320, 240]\n"));
  EXPECT_EQ(k.fx_px, 400.0);
  EXPECT_EQ(k.fy_px, 401.0);
  EXPECT_EQ(k.cx_px, 320.0);
  EXPECT_EQ(k.cy_px, 240.0);
  EXPECT_THAT(message_of([&] { (void)read_intrinsics(value_of(folder, "v: [1, 2, 3]\n")); }),
              HasSubstr("v: expected 4 numbers, found 3"));
}

TEST(YamlGeometryTest, ComplaintsNameThePlace) {
  const TempFolder folder;
  const YamlValue map = YamlValue::load(folder.write("a.yaml", "\nv: 1\n"));
  EXPECT_THAT(error_at(map.at("v"))("wrong").what(), HasSubstr("a.yaml:2: v: wrong"));
  EXPECT_THAT(error_at(map, "v")("wrong").what(), HasSubstr("a.yaml:2: v: wrong"));
  EXPECT_THAT(error_at(map, "w")("wrong").what(), HasSubstr("a.yaml: w: wrong"));
}

TEST(YamlGeometryTest, ASideIsWithinTheLimits) {
  const TempFolder folder;
  EXPECT_EQ(read_side_px(value_of(folder, "v: 16384\n")), 16384);
  EXPECT_THAT(message_of([&] { (void)read_side_px(value_of(folder, "v: 16385\n")); }),
              HasSubstr("a.yaml:1: v: expected a whole number of pixels in 1...16384"));
}

}  // namespace
}  // namespace skyhalo
