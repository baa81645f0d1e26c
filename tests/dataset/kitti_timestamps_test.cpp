#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "skyhalo/dataset/kitti_raw.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// 2011-09-26 13:02:25: 15 243 days (see the time stamps' own test) and 46 945 s.
constexpr std::int64_t kSecond = 15243LL * 86400 + 13 * 3600LL + 2 * 60LL + 25;

Timestamp stamp_at(std::int64_t second, std::int64_t nanosecond) {
  return Timestamp{std::chrono::nanoseconds(second * 1'000'000'000 + nanosecond)};
}

TEST(KittiTimestampsTest, ReadsAStampOnEachLine) {
  const TempFolder folder;
  const auto file =
      folder.write("timestamps.txt",
                   "2011-09-26 13:02:25.500000000\n2011-09-26 13:02:25.625000000\r\n\n"
                   "1970-01-01 00:00:00.000000000");
  EXPECT_THAT(
      read_kitti_timestamps(file),
      ElementsAre(stamp_at(kSecond, 500'000'000), stamp_at(kSecond, 625'000'000), stamp_at(0, 0)));
}

TEST(KittiTimestampsTest, KeepsEveryNanosecond) {
  const TempFolder folder;
  const auto file = folder.write("timestamps.txt",
                                 "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:25.000000001\n"
                                 "2011-09-26 13:02:25.999999999\n2011-09-26 13:02:25.067437569\n");
  EXPECT_THAT(read_kitti_timestamps(file),
              ElementsAre(stamp_at(kSecond, 964'389'445),
                          stamp_at(kSecond, 1),
                          stamp_at(kSecond, 999'999'999),
                          stamp_at(kSecond, 67'437'569)));
}

TEST(KittiTimestampsTest, KnowsLeapYears) {
  // 2012-02-29 is day 31 + 28 of the year that began 15 340 days after 1970.
  const TempFolder folder;
  const auto file = folder.write("timestamps.txt", "2012-02-29 00:00:00.000000000\n");
  EXPECT_THAT(read_kitti_timestamps(file), ElementsAre(stamp_at((15340LL + 59) * 86400, 0)));
}

TEST(KittiTimestampsTest, AMalformedLineIsRefused) {
  const TempFolder folder;
  for (const std::string bad : {"x",
                                "2011-09-26",
                                "2011-09-26 13:02",
                                "20x1-09-26 13:02:25.0",
                                "2011-13-26 13:02:25.0",
                                "2011-02-30 13:02:25.0",
                                "2011-00-10 13:02:25.0",
                                "2011-09-26 24:02:25.0",
                                "2011-09-26 13:60:25.0",
                                "2011-09-26 13:02:61.0",
                                "2011-09-26 13:02:-5.0",
                                "2011-09-26 13:02:nan",
                                "2011-09-26 13:02:xx.0",
                                "2011/09/26 13:02:25.0",
                                "2011-09-26 13:02:25.0 more",
                                "26-09-2011 13:02:25.0",
                                "2011-09-26 1x:02:25.0"}) {
    SCOPED_TRACE(bad);
    const auto file = folder.write("timestamps.txt", "2011-09-26 13:02:25.0\n" + bad + "\n");
    EXPECT_THAT(message_of([&] { (void)read_kitti_timestamps(file); }),
                HasSubstr(file.string() + ":2:"));
  }
}

TEST(KittiTimestampsTest, AFileWithoutStampsIsRefused) {
  const TempFolder folder;
  const auto empty = folder.write("timestamps.txt", "\n");
  EXPECT_THAT(message_of([&] { (void)read_kitti_timestamps(empty); }), HasSubstr(empty.string()));
  const auto missing = folder.path() / "missing.txt";
  EXPECT_THAT(message_of([&] { (void)read_kitti_timestamps(missing); }),
              HasSubstr(missing.string()));
}

TEST(KittiTimestampsProperty, AnyNanosecondOfAMinuteIsKept) {
  const TempFolder folder;
  std::mt19937 random(16);
  std::uniform_int_distribution<std::int64_t> nanosecond(0, 59'999'999'999);
  std::string text;
  std::vector<Timestamp> expected;
  for (int i = 0; i < 500; ++i) {
    const std::int64_t ns = nanosecond(random);
    std::array<char, 64> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "2011-09-26 13:02:%02lld.%09lld\n",
                  static_cast<long long>(ns / 1'000'000'000),
                  static_cast<long long>(ns % 1'000'000'000));
    text += line.data();
    expected.push_back(stamp_at(kSecond - 25, ns));
  }
  EXPECT_TRUE(read_kitti_timestamps(folder.write("timestamps.txt", text)) == expected);
}

}  // namespace
}  // namespace skyhalo
