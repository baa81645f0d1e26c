#include "skyhalo/dataset/velodyne_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

std::string bytes_of(const std::vector<std::array<float, 4>>& records) {
  std::string bytes(records.size() * 16, '\0');
  std::memcpy(bytes.data(), records.data(), bytes.size());
  return bytes;
}

TEST(VelodyneFileTest, ReadsRecordsOfFourFloats) {
  const TempFolder folder;
  // IEEE 754, low byte first: 1 = 3f800000, -2 = c0000000, 0.5 = 3f000000, 0.25 = 3e800000.
  const std::string bytes("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x00\x00\x80\x3e", 16);
  EXPECT_THAT(read_velodyne(folder.write("scan.bin", bytes)),
              ElementsAre(Eigen::Vector3f(1.0F, -2.0F, 0.5F)));
}

TEST(VelodyneFileTest, PointsThatAreNotFiniteAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const TempFolder folder;
  const auto file = folder.write("scan.bin",
                                 bytes_of({{kNan, 0.0F, 0.0F, 0.0F},
                                           {1.0F, 2.0F, 3.0F, kNan},
                                           {0.0F, -kInfinity, 0.0F, 0.0F},
                                           {0.0F, 0.0F, kInfinity, 0.0F},
                                           {4.0F, 5.0F, 6.0F, 0.0F}}));
  EXPECT_THAT(read_velodyne(file),
              ElementsAre(Eigen::Vector3f(1.0F, 2.0F, 3.0F), Eigen::Vector3f(4.0F, 5.0F, 6.0F)));
}

TEST(VelodyneFileTest, AFileThatIsCutOffIsRefused) {
  const TempFolder folder;
  const std::string bytes = bytes_of({{1.0F, 2.0F, 3.0F, 4.0F}, {1.0F, 2.0F, 3.0F, 4.0F}});
  for (const std::size_t length : {0U, 1U, 4U, 12U, 15U, 17U, 28U, 31U}) {
    SCOPED_TRACE(length);
    const auto file = folder.write("0000000005.bin", bytes.substr(0, length));
    EXPECT_THAT(message_of([&] { (void)read_velodyne(file); }), HasSubstr(file.string()));
  }
}

TEST(VelodyneFileTest, AMissingFileIsNamed) {
  const TempFolder folder;
  const auto file = folder.path() / "0000000005.bin";
  EXPECT_THAT(message_of([&] { (void)read_velodyne(file); }), HasSubstr(file.string()));
}

TEST(VelodyneFileProperty, EveryPointIsReadBack) {
  const TempFolder folder;
  std::mt19937 random(18);
  std::uniform_real_distribution<float> length(-80.0F, 80.0F);
  std::vector<std::array<float, 4>> records(1000);
  for (auto& record : records) {
    record = {length(random), length(random), length(random), 0.5F};
  }
  const LaserScan scan = read_velodyne(folder.write("scan.bin", bytes_of(records)));
  ASSERT_EQ(scan.size(), records.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_EQ(scan[i], Eigen::Vector3f(records[i][0], records[i][1], records[i][2]));
  }
}

TEST(VelodyneFileTest, WritesRecordsOfFourFloats) {
  const TempFolder folder;
  const auto file = folder.path() / "scan.bin";
  write_velodyne(file, {{{1.0F, -2.0F, 0.5F}, {4.0F, 5.0F, 6.0F}}, {0.25F, 1.0F}});
  EXPECT_EQ(read_bytes(file), bytes_of({{1.0F, -2.0F, 0.5F, 0.25F}, {4.0F, 5.0F, 6.0F, 1.0F}}));
  write_velodyne(file, {{{1.0F, -2.0F, 0.5F}}, {}});
  EXPECT_EQ(read_bytes(file), bytes_of({{1.0F, -2.0F, 0.5F, 0.0F}}));
  write_velodyne(file, {});
  EXPECT_EQ(read_bytes(file), "");
}

TEST(VelodyneFileTest, AScanThatCannotBeReadBackIsNotWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "scan.bin";
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of([&] {
                write_velodyne(file, {{{1.0F, kNan, 0.5F}}, {}});
              }),
              HasSubstr("scan.bin: point 0 of the scan is not finite"));
  EXPECT_THAT(message_of([&] {
                write_velodyne(file, {{{1.0F, 2.0F, 0.5F}}, {0.1F, 0.2F}});
              }),
              HasSubstr("expected a reflectance for each of 1 points, found 2"));
}

}  // namespace
}  // namespace skyhalo
