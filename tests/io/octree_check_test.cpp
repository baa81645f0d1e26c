#include "skyhalo/io/octree_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;

const std::string kBinary = "# Octomap OcTree binary file\n# comment\n";
const std::string kFull = "# Octomap OcTree file\n";

std::string bytes_of(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) {
    text.push_back(static_cast<char>(byte));
  }
  return text;
}

std::string binary_file(int nodes, const std::string& data) {
  return kBinary + "id OcTree\nsize " + std::to_string(nodes) + "\nres 0.25\ndata\n" + data;
}

std::string full_file(int nodes, const std::string& data) {
  return kFull + "id OcTree\nsize " + std::to_string(nodes) + "\nres 0.25\ndata\n" + data;
}

/// A node of a `.ot` file.
std::string full_node(float log_odds, int children) {
  std::string bytes(sizeof(log_odds), '\0');
  std::memcpy(bytes.data(), &log_odds, sizeof(log_odds));
  bytes.push_back(static_cast<char>(children));
  return bytes;
}

OctreeShape shape(const std::string& bytes, OctreeForm form = OctreeForm::kBinary) {
  return check_octree("map", bytes, form);
}

std::string refusal(const std::string& bytes, OctreeForm form = OctreeForm::kBinary) {
  return message_of([&] { (void)check_octree("folder/map", bytes, form); });
}

/// `levels` inner nodes with one inner child each, and a last with a free first child.
std::string binary_path(int levels) {
  std::string data;
  for (int i = 0; i < levels; ++i) {
    data += bytes_of({3, 0});
  }
  return data + bytes_of({1, 0});
}

TEST(OctreeCheckTest, AnEmptyTreeHasNoNodes) {
  const OctreeShape found = shape(binary_file(0, ""));
  EXPECT_EQ(found.voxel_m, 0.25);
  EXPECT_EQ(found.nodes, 0U);
  EXPECT_EQ(found.uniform_bricks + found.mixed_bricks, 0U);
  EXPECT_EQ(found.data_from, binary_file(0, "").size());
}

TEST(OctreeCheckTest, LargeLeavesCountAllTheirBricks) {
  // The root's children cover 2^15 cells a side: 4096^3 bricks of 8.
  const OctreeShape found = shape(binary_file(3, bytes_of({2, 64})));
  EXPECT_EQ(found.nodes, 3U);
  EXPECT_EQ(found.inner_nodes, 1U);
  EXPECT_EQ(found.uniform_bricks, 2 * (std::uint64_t{1} << 36U));
  EXPECT_EQ(found.mixed_bricks, 0U);
}

TEST(OctreeCheckTest, ADeepLeafIsInOneMixedBrick) {
  const OctreeShape found = shape(binary_file(17, binary_path(15)));
  EXPECT_EQ(found.inner_nodes, 16U);
  EXPECT_EQ(found.uniform_bricks, 0U);
  EXPECT_EQ(found.mixed_bricks, 1U);
}

TEST(OctreeCheckTest, ALeafOfEightCellsIsOneUniformBrick) {
  const OctreeShape found = shape(binary_file(14, binary_path(12)));  // at depth 13
  EXPECT_EQ(found.uniform_bricks, 1U);
  EXPECT_EQ(found.mixed_bricks, 0U);
}

TEST(OctreeCheckTest, NodesWithLogOddsAreCounted) {
  const std::string data =
      full_node(1.0F, 0b101) + full_node(1.0F, 0) + full_node(0.5F, 0b1) + full_node(0.5F, 0);
  const OctreeShape found = shape(full_file(4, data), OctreeForm::kFull);
  EXPECT_EQ(found.nodes, 4U);
  EXPECT_EQ(found.inner_nodes, 2U);
  // 2^15 cells a side are 2^12 bricks, 2^14 cells 2^11.
  EXPECT_EQ(found.uniform_bricks, (std::uint64_t{1} << 36U) + (std::uint64_t{1} << 33U));
}

TEST(OctreeCheckTest, OneNodeWithLogOddsIsTheWholeTree) {
  const OctreeShape found = shape(full_file(1, full_node(1.0F, 0)), OctreeForm::kFull);
  EXPECT_EQ(found.uniform_bricks, std::uint64_t{1} << 39U);
  EXPECT_EQ(found.inner_nodes, 0U);
}

TEST(OctreeCheckTest, WindowsLineEndsInTheHeaderAreRead) {
  EXPECT_EQ(
      shape("# Octomap OcTree binary file\r\nid OcTree\r\nsize 0\r\nres 0.1\r\ndata\r\n").voxel_m,
      0.1);
}

TEST(OctreeCheckTest, TooManyLevelsAreRefused) {
  EXPECT_THAT(refusal(binary_file(18, binary_path(16))), HasSubstr("more than 16 levels"));
  EXPECT_THAT(refusal(binary_file(100'001, binary_path(100'000))),
              HasSubstr("more than 16 levels"));
  std::string data;
  for (int i = 0; i < 16; ++i) {
    data += full_node(1.0F, 1);
  }
  EXPECT_EQ(shape(full_file(17, data + full_node(1.0F, 0)), OctreeForm::kFull).nodes, 17U);
  EXPECT_THAT(
      refusal(full_file(18, data + full_node(1.0F, 1) + full_node(1.0F, 0)), OctreeForm::kFull),
      HasSubstr("more than 16 levels"));
}

TEST(OctreeCheckTest, CutOffAndLongerTreesAreRefused) {
  const std::string whole = binary_file(17, binary_path(15));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_THAT(refusal(whole.substr(0, length)), HasSubstr("folder/map"));
  }
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 1)), HasSubstr("cut off after"));
  EXPECT_THAT(refusal(whole + "x"), HasSubstr("1 bytes follow the end"));
  EXPECT_THAT(refusal(binary_file(0, "xx")), HasSubstr("2 bytes follow the end"));
  const std::string full = full_file(1, full_node(1.0F, 0));
  for (std::size_t less = 1; less <= 5; ++less) {
    EXPECT_THAT(refusal(full.substr(0, full.size() - less), OctreeForm::kFull),
                HasSubstr("cut off after"));
  }
  EXPECT_THAT(refusal(full + std::string(1, '\0'), OctreeForm::kFull), HasSubstr("follow the end"));
}

TEST(OctreeCheckTest, AnotherNumberOfNodesIsRefused) {
  EXPECT_THAT(refusal(binary_file(16, binary_path(15))),
              AllOf(HasSubstr("17 nodes"), HasSubstr("expected 16")));
}

TEST(OctreeCheckTest, AnInnerNodeWithoutChildrenIsRefused) {
  EXPECT_THAT(refusal(binary_file(1, bytes_of({0, 0}))), HasSubstr("has none"));
  EXPECT_THAT(refusal(binary_file(2, bytes_of({3, 0, 0, 0}))), HasSubstr("has none"));
}

TEST(OctreeCheckTest, LogOddsThatAreNotFiniteAreRefused) {
  for (const float value : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
    EXPECT_THAT(refusal(full_file(1, full_node(value, 0)), OctreeForm::kFull),
                HasSubstr("not finite"));
  }
}

TEST(OctreeCheckTest, OtherTreesAreNamed) {
  EXPECT_THAT(refusal(kFull + "id ColorOcTree\nsize 0\nres 0.1\ndata\n", OctreeForm::kFull),
              AllOf(HasSubstr("id ColorOcTree"), HasSubstr("expected id OcTree")));
  EXPECT_THAT(refusal(kFull + "id \x1b[31m\nsize 0\nres 0.1\ndata\n", OctreeForm::kFull),
              HasSubstr("id ?[31m"));
  EXPECT_THAT(refusal(kFull + "size 0\nres 0.1\ndata\n", OctreeForm::kFull),
              HasSubstr("expected id OcTree"));
  EXPECT_THAT(refusal(full_file(0, "")), HasSubstr("which is called .ot, not .bt"));
  EXPECT_THAT(refusal(binary_file(0, ""), OctreeForm::kFull),
              HasSubstr("which is called .bt, not .ot"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\n"), HasSubstr("no OctoMap file"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
}

/// A header that ends with a key and its value.
std::string with_line(const std::string& key, const std::string& value) {
  std::string bytes = kBinary;
  bytes += key;
  bytes += value;
  bytes += '\n';
  return bytes;
}

TEST(OctreeCheckTest, HeaderLinesThatAreWrongAreNamed) {
  EXPECT_THAT(refusal(kBinary + "id OcTree\nsize 0\nres 0.1\n"), HasSubstr("cut off"));
  EXPECT_THAT(refusal(kBinary + "id OcTree\nres 0.1\ndata\n"), HasSubstr("no size"));
  EXPECT_THAT(refusal(kBinary + "id OcTree\nsize 0\ndata\n"), HasSubstr("no res"));
  EXPECT_THAT(refusal(kBinary + "id OcTree\nsize 0\nsize 0\n"), HasSubstr("map:5: size is there"));
  EXPECT_THAT(refusal(kBinary + "colour red\n"), HasSubstr("map:3: expected id"));
  for (const std::string value : {"-1", "1.5", "x", "", "1 2", "99999999999999999999999"}) {
    EXPECT_THAT(refusal(with_line("size ", value)), HasSubstr("map:3: size: expected"));
  }
  for (const std::string value : {"x", "", "nan", "inf", "1 2"}) {
    EXPECT_THAT(refusal(with_line("res ", value)), HasSubstr("map:3: res: expected"));
  }
  for (const std::string value : {"0", "-0.1", "1e-30", "1e30"}) {
    EXPECT_THAT(refusal(with_line("id OcTree\nsize 0\nres ", value) + "data\n"),
                HasSubstr("has cells of"));
  }
}

}  // namespace
}  // namespace skyhalo
