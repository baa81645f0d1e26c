#include "skyhalo/io/skymap_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "io/map_cases.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::difference;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TempFolder;

class SkymapFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] Skymap written_and_read(const SparseMap& map, const SkymapInfo& info = {}) const {
    write_skymap(file, map, info);
    return read_skymap(file);
  }

  void expect_same(const SparseMap& map) const {
    const Skymap read = written_and_read(map);
    EXPECT_THAT(difference(map, read.map), IsEmpty());
    EXPECT_EQ(read.map.bricks(), map.bricks());
    for (const Eigen::Vector3i& brick : map.bricks()) {
      EXPECT_EQ(read.map.uniform(brick), map.uniform(brick)) << brick.transpose();
    }
  }

  TempFolder folder;
  std::filesystem::path file = folder.path() / "map.skymap";
};

using SkymapFileProperty = SkymapFileTest;

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// Both were put together by Python's struct and zlib and the program zstd, from the description in
// `skymap_format.hpp`.
constexpr const char* kEmptyHex =
    "89534b590d0a1a0a010000005c000000000000000000f8bf000000000000d03f0000000000002040000000000000"
    "e03ffca9f1d24d62503f881300000002000000000000000000000000000000000000000000000000000030"
    "6d1fc189594b530d0a1a0a0000000000000000000000000000000000000000";
constexpr const char* kTwoBricksHex =
    "89534b590d0a1a0a010000005c000000000000000000f8bf000000000000d03f0000000000002040000000000000"
    "e03ffca9f1d24d62503f8813000000020000020000000000000001000000000000001c04000000000000d9301769"
    "020000001c0400002e0000006e7c6f9b28b52ffd00682d0100e0ffffffff00000000020000000300fcffffff0001"
    "30f8dc050080f9ff0200f7733519801289594b530d0a1a0a02000000000000003e00000000000000aa3689bb";

const VoxelLattice kLattice{.origin_m = {-1.5, 0.25, 8.0}, .voxel_m = 0.5};

TEST_F(SkymapFileTest, VersionOneIsReadAsItIsDescribed) {
  const Skymap read = read_skymap(folder.write("map.skymap", from_hex(kTwoBricksHex)));
  EXPECT_EQ(read.info.limit_units, 5000);
  EXPECT_EQ(read.map.lattice(), kLattice);
  ASSERT_EQ(read.map.brick_count(), 2U);
  EXPECT_EQ(read.map.uniform({-1, 0, 2}), LogOdds{-2000});
  EXPECT_EQ(read.map.at({24, 0, -32}), 1500);
  EXPECT_EQ(read.map.at({31, 7, -25}), -7);
  EXPECT_EQ(read.map.at({24, 0, -31}), kUnknown);
}

TEST_F(SkymapFileTest, AnEmptyMapIsWrittenAsItIsDescribed) {
  // Nothing of it depends on how well zstd packs.
  write_skymap(file, SparseMap(kLattice), {.limit_units = 5000});
  EXPECT_EQ(read_bytes(file), from_hex(kEmptyHex));
  const Skymap read = read_skymap(file);
  EXPECT_EQ(read.map.lattice(), kLattice);
  EXPECT_EQ(read.map.brick_count(), 0U);
}

TEST_F(SkymapFileTest, UniformAndMixedBricksComeBack) {
  SparseMap map(kLattice);
  map.set_uniform({0, 0, 0}, -3000);
  map.set_uniform({-1, -1, -1}, 0);
  map.set({-100, 17, 3}, 5000);
  map.set({-100, 17, 4}, -1);
  expect_same(map);
}

TEST_F(SkymapFileTest, ExtremesComeBack) {
  SparseMap map({.origin_m = {1e9, -1e9, 0.1}, .voxel_m = 1.0 / 3.0});
  constexpr int kReach = VoxelLattice::kReach;
  map.set({-kReach, -kReach, -kReach}, 32767);
  map.set({kReach - 1, kReach - 1, kReach - 1}, -32767);
  map.set_uniform({0, 0, 0}, 32767);
  map.set_uniform({0, 0, 1}, -32767);
  expect_same(map);
}

TEST_F(SkymapFileTest, TheLimitComesBack) {
  for (const int limit : {1, 4242, 32767}) {
    EXPECT_EQ(written_and_read(SparseMap(kLattice), {.limit_units = limit}).info.limit_units,
              limit);
  }
}

TEST_F(SkymapFileTest, MapsThatHoldTheSameGiveEqualBytes) {
  SparseMap by_cells(kLattice);
  for (std::size_t place = 0; place < kBrickCells; ++place) {
    by_cells.set(cell_in_brick({1, 2, 3}, place), -700);
  }
  by_cells.set({0, 0, 0}, 5);
  by_cells.set({900, 0, 0}, 5);
  by_cells.set({900, 0, 0}, kUnknown);
  SparseMap by_bricks(kLattice);
  by_bricks.set({0, 0, 0}, 5);
  by_bricks.set_uniform({1, 2, 3}, -700);
  write_skymap(file, by_cells, {});
  const std::string bytes = read_bytes(file);
  write_skymap(file, by_bricks, {});
  EXPECT_EQ(read_bytes(file), bytes);
  const SparseMap read = read_skymap(file).map;
  EXPECT_EQ(read.brick_count(), 2U);
  EXPECT_EQ(read.uniform({1, 2, 3}), LogOdds{-700});
}

TEST_F(SkymapFileTest, ProgressGoesToOne) {
  std::vector<double> shares;
  const Progress progress = [&](double share) { shares.push_back(share); };
  write_skymap(file, testing::random_map(3, 2000), {}, progress);
  (void)read_skymap(file, kMapMemoryBytes, progress);
  ASSERT_GE(shares.size(), 6U) << "blocks have 512 bricks";
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_EQ(shares[shares.size() / 2 - 1], 1.0);
  EXPECT_LT(shares.front(), 0.5);
}

TEST_F(SkymapFileTest, AStopLeavesTheEarlierFile) {
  (void)folder.write("map.skymap", from_hex(kTwoBricksHex));
  const auto stop = [](double /*share*/) { throw Error(ErrorKind::kCancelled, "stop"); };
  EXPECT_EQ(message_of([&] { write_skymap(file, testing::random_map(3, 20), {}, stop); },
                       ErrorKind::kCancelled),
            "stop");
  EXPECT_EQ(read_bytes(file), from_hex(kTwoBricksHex));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST_F(SkymapFileTest, AMapThatCouldNotBeReadBackIsNotWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](const VoxelLattice& lattice, int limit) {
    return message_of([&] { write_skymap(file, SparseMap(lattice), {.limit_units = limit}); });
  };
  EXPECT_THAT(refusal({.origin_m = {nan, 0.0, 0.0}, .voxel_m = 0.5}, 5000), HasSubstr("origin"));
  EXPECT_THAT(refusal({.voxel_m = 1e-5}, 5000), HasSubstr("cells of 1e-05 m"));
  EXPECT_THAT(refusal(kLattice, 0), HasSubstr("limit"));
  EXPECT_THAT(refusal(kLattice, 32768), HasSubstr("limit"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(SkymapFileTest, AFolderThatIsMissingIsAFailure) {
  const auto missing = folder.path() / "none" / "map.skymap";
  EXPECT_THAT(
      message_of([&] { write_skymap(missing, SparseMap(kLattice), {}); }, ErrorKind::kFailure),
      HasSubstr(missing.string()));
}

TEST_F(SkymapFileTest, ADiskThatIsFullIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full on this system";
  }
  EXPECT_THAT(message_of([&] { write_skymap("/dev/full", testing::random_map(1, 4000), {}); },
                         ErrorKind::kFailure),
              HasSubstr("/dev/full"));
}

TEST_F(SkymapFileProperty, RandomMapsComeBack) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    expect_same(testing::random_map(seed, 1 << (2 * seed), 1 << seed));
  }
}

}  // namespace
}  // namespace skyhalo
