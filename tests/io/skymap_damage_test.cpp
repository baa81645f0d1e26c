// What `read_skymap` does with files that are damaged, or made to do harm.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "io/map_cases.hpp"
#include "io/skymap_bytes.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/sanitised.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::SkymapBytes;
using testing::TempFolder;

class SkymapDamageTest : public ::testing::Test {
 protected:
  /// What is said of these bytes as a file.
  [[nodiscard]] std::string refusal(const std::string& bytes,
                                    std::uint64_t max_bytes = kMapMemoryBytes) const {
    // Some file systems bring a file to the disk when it is replaced in place.
    std::filesystem::remove(folder.path() / "map.skymap");
    const auto file = folder.write("map.skymap", bytes);
    std::string message = message_of([&] { (void)read_skymap(file, max_bytes); });
    EXPECT_THAT(message, HasSubstr(file.string()));
    return message;
  }

  [[nodiscard]] std::string small_file() const {
    SparseMap map({.origin_m = {-1.0, 0.0, 2.5}, .voxel_m = 0.5});
    map.set_uniform({-3, 0, 7}, -2000);
    map.set_uniform({4, 0, 7}, 150);
    for (int i = 0; i < 100; ++i) {
      map.set({i % 8, i / 8 % 8, i / 64}, static_cast<LogOdds>(37 * i));
    }
    write_skymap(folder.path() / "small.skymap", map, {});
    return read_bytes(folder.path() / "small.skymap");
  }

  TempFolder folder;
};

std::string uniform_place(int i) {
  return SkymapBytes::place(0, 0, i);
}

// --- damage

TEST_F(SkymapDamageTest, EveryByteThatChangesIsFound) {
  std::string bytes = small_file();
  std::mt19937 random(1);
  std::uniform_int_distribution flip(1, 255);
  for (char& byte : bytes) {
    const char before = byte;
    for (const int change : {flip(random), 1, 128}) {
      byte = static_cast<char>(before ^ change);
      EXPECT_THAT(refusal(bytes), HasSubstr("map.skymap: "));
    }
    byte = before;
  }
}

TEST_F(SkymapDamageTest, EveryCutIsFound) {
  const std::string bytes = small_file();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THAT(refusal(bytes.substr(0, length)),
                ::testing::AnyOf(HasSubstr("cut off"), HasSubstr("is empty")));
  }
}

TEST_F(SkymapDamageTest, BytesBehindTheEndAreFound) {
  EXPECT_THAT(refusal(small_file() + "\n"), HasSubstr("bytes follow its end"));
  EXPECT_THAT(refusal(small_file() + small_file()), HasSubstr("bytes follow its end"));
}

TEST_F(SkymapDamageTest, PiecesOfAnotherFileAreFound) {
  write_skymap(folder.path() / "other.skymap", testing::random_map(6, 9, 2), {});
  const std::string other = read_bytes(folder.path() / "other.skymap");
  const std::string bytes = small_file();
  EXPECT_THAT(refusal(bytes.substr(0, 92) + other.substr(92)), HasSubstr("damaged"));
  EXPECT_THAT(refusal(bytes.substr(0, bytes.size() - 28) + other.substr(other.size() - 28)),
              HasSubstr("its end does not match"));
}

TEST_F(SkymapDamageTest, AFileThatWasSentAsTextIsNamedSo) {
  std::string unix_ends = small_file();
  unix_ends.erase(unix_ends.find('\r'), 1);
  EXPECT_THAT(refusal(unix_ends), HasSubstr("sent as text"));
  std::string windows_ends = small_file();
  windows_ends.insert(windows_ends.rfind('\n', 8), "\r");
  EXPECT_THAT(refusal(windows_ends), HasSubstr("sent as text"));
  std::string seven_bits = small_file();
  seven_bits[0] = static_cast<char>(seven_bits[0] & 0x7F);
  EXPECT_THAT(refusal(seven_bits), HasSubstr("sent as text"));
}

// --- other files

TEST_F(SkymapDamageTest, OtherFilesAreNamedSo) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("# Octomap OcTree file\nid OcTree\n"), HasSubstr("no .skymap file"));
  EXPECT_THAT(refusal(std::string(200, '\0')), HasSubstr("no .skymap file"));
  const auto missing = folder.path() / "none.skymap";
  EXPECT_THAT(message_of([&] { (void)read_skymap(missing); }), HasSubstr("no such file"));
  EXPECT_THAT(message_of([&] { (void)read_skymap(folder.path()); }), HasSubstr("regular file"));
  EXPECT_THAT(message_of([&] { (void)read_skymap("/dev/zero"); }), HasSubstr("regular file"));
}

TEST_F(SkymapDamageTest, AnotherVersionIsNamed) {
  SkymapBytes file;
  file.version = 2;
  EXPECT_THAT(refusal(file.bytes()), AllOf(HasSubstr("version 2"), HasSubstr("version 1")));
}

// --- headers that lie

TEST_F(SkymapDamageTest, TheWriterOfTheseTestsWritesGoodFiles) {
  const auto file = folder.write(
      "map.skymap", SkymapBytes::of_uniform({uniform_place(1), uniform_place(2)}).bytes());
  EXPECT_EQ(read_skymap(file).map.bricks(), (std::vector<Eigen::Vector3i>{{0, 0, 1}, {0, 0, 2}}));
}

TEST_F(SkymapDamageTest, SillyHeadersAreRefused) {
  const auto with = [](const auto& change) {
    SkymapBytes file;
    change(file);
    return file.bytes();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double voxel_m : {0.0, -0.5, nan, 1e-300, 1e300, HUGE_VAL}) {
    EXPECT_THAT(refusal(with([&](SkymapBytes& file) { file.voxel_m = voxel_m; })),
                HasSubstr("has cells of"));
  }
  for (const double x_m : {nan, HUGE_VAL, -1e10}) {
    EXPECT_THAT(refusal(with([&](SkymapBytes& file) { file.origin_m[1] = x_m; })),
                HasSubstr("origin"));
  }
  for (const int limit : {0, -5000, 32768}) {
    EXPECT_THAT(refusal(with([&](SkymapBytes& file) { file.limit = limit; })),
                HasSubstr("limits log odds"));
  }
  EXPECT_THAT(refusal(with([](SkymapBytes& file) { file.unit = 0.01; })), HasSubstr("units"));
  EXPECT_THAT(refusal(with([](SkymapBytes& file) { file.header_bytes = 93; })),
              HasSubstr("header of another length"));
  EXPECT_THAT(refusal(with([](SkymapBytes& file) { file.most_bricks = 513; })),
              HasSubstr("blocks of another size"));
  EXPECT_THAT(refusal(with([](SkymapBytes& file) { file.unpacked_bytes = 1; })),
              HasSubstr("contradict"));
}

TEST_F(SkymapDamageTest, CountsThatOverflowAreRefused) {
  constexpr std::uint64_t kMost = ~std::uint64_t{0};
  for (const auto& [bricks, mixed] : {std::pair{kMost, kMost},
                                      {kMost, std::uint64_t{0}},
                                      {std::uint64_t{1} << 60U, std::uint64_t{1} << 60U},
                                      {kMost / 192 + 1, std::uint64_t{0}},
                                      {std::uint64_t{1} << 23U, std::uint64_t{1} << 22U}}) {
    SkymapBytes file;
    file.bricks = bricks;
    file.mixed = mixed;
    file.unpacked_bytes = skymap::unpacked_bytes(bricks, mixed);
    EXPECT_THAT(refusal(file.bytes()), HasSubstr("more than 4096 MiB"));
  }
  SkymapBytes file;
  file.bricks = 1;
  file.mixed = 2;
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("contradict"));
}

TEST_F(SkymapDamageTest, MoreBricksClaimedThanThereAreIsACut) {
  SkymapBytes file = SkymapBytes::of_uniform(std::vector<std::string>(512, uniform_place(1)));
  file.blocks.clear();
  EXPECT_THAT(refusal(file.bytes()), ::testing::AnyOf(HasSubstr("cut off"), HasSubstr("damaged")));
}

// --- blocks that lie

TEST_F(SkymapDamageTest, BricksTwiceOrUnsortedAreRefused) {
  const std::string a = SkymapBytes::place(0, 5, -3);
  for (const std::string& b : {a,
                               SkymapBytes::place(0, 5, -4),
                               SkymapBytes::place(0, 4, 9),
                               SkymapBytes::place(-1, 9, 9)}) {
    EXPECT_THAT(refusal(SkymapBytes::of_uniform({a, b}).bytes()), HasSubstr("not sorted"));
  }
}

TEST_F(SkymapDamageTest, BricksBeyondTheCellsAreRefused) {
  constexpr int kReach = VoxelLattice::kReach / kBrickEdge;
  for (const std::string& place : {SkymapBytes::place(kReach, 0, 0),
                                   SkymapBytes::place(0, -kReach - 1, 0),
                                   SkymapBytes::place(0, 0, 2147483647),
                                   SkymapBytes::place(0, 0, -2147483647 - 1)}) {
    EXPECT_THAT(refusal(SkymapBytes::of_uniform({place}).bytes()), HasSubstr("numbered"));
  }
}

TEST_F(SkymapDamageTest, ABrickWithoutKnownCellsIsRefused) {
  SkymapBytes file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].unpacked.replace(13, 2, SkymapBytes::value(kUnknown));
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("without a known cell"));
  SkymapBytes mixed;
  mixed.blocks.push_back({.unpacked = uniform_place(0) + '\1', .bricks = 1});
  for (int i = 0; i < kBrickCells; ++i) {
    mixed.blocks[0].unpacked += SkymapBytes::value(kUnknown);
  }
  mixed.bricks = mixed.mixed = 1;
  mixed.unpacked_bytes = mixed.blocks[0].unpacked.size();
  EXPECT_THAT(refusal(mixed.bytes()), HasSubstr("bricks are not those"));
}

TEST_F(SkymapDamageTest, KindsAndSizesMustFit) {
  SkymapBytes file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].unpacked[12] = '\1';  // mixed, but without its cells
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("bricks of other kinds"));
  file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].unpacked[12] = '\2';
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("bricks of other kinds"));
  file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].unpacked += "more";
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("bricks of other kinds"));
  file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].unpacked.resize(5);
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("shorter than its bricks"));
  for (const std::uint32_t bricks : {0U, 2U, 0xFFFFFFFFU}) {
    file = SkymapBytes::of_uniform({uniform_place(0)});
    file.blocks[0].bricks = bricks;
    EXPECT_THAT(refusal(file.bytes()), HasSubstr("expected 1"));
  }
}

TEST_F(SkymapDamageTest, BlocksThatUnpackToMoreThanTheyClaimAreRefused) {
  SkymapBytes file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].packed = SkymapBytes::pack(std::string(std::size_t{1} << 28U, 'x'));
  EXPECT_THAT(refusal(file.bytes()),
              ::testing::AnyOf(HasSubstr("cannot be unpacked"), HasSubstr("claims more bytes")));
  file.blocks[0].packed = SkymapBytes::pack(std::string(2000, 'x'));
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("cannot be unpacked"));
  for (const std::uint32_t claim : {14U, 16U, 1037U}) {
    file = SkymapBytes::of_uniform({uniform_place(0)});
    file.blocks[0].unpacked_bytes = claim;
    EXPECT_THAT(refusal(file.bytes()), HasSubstr("cannot be unpacked"));
  }
  for (const std::uint32_t claim : {1038U, 0xFFFFFFFFU}) {
    file = SkymapBytes::of_uniform({uniform_place(0)});
    file.blocks[0].unpacked_bytes = claim;
    EXPECT_THAT(refusal(file.bytes()), HasSubstr("claims more bytes"));
  }
  file = SkymapBytes::of_uniform({uniform_place(0)});
  file.blocks[0].packed_bytes = 0xFFFFFFFFU;
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("claims more bytes"));
}

// --- memory

/// How much the most memory of a process of its own grows while it reads (bytes), or -1 when the
/// file is refused.
std::int64_t growth_while_reading(const std::filesystem::path& file, std::uint64_t max_bytes) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return -2;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    const auto most_kib = [] {
      rusage usage{};
      ::getrusage(RUSAGE_SELF, &usage);
      return std::int64_t{usage.ru_maxrss};
    };
    std::int64_t growth = -1;
    try {
      const std::int64_t before = most_kib();
      const Skymap read = read_skymap(file, max_bytes);
      growth = (most_kib() - before) * 1024;
    } catch (const Error&) {
      growth = -1;
    }
    const bool told = ::write(ends[1], &growth, sizeof(growth)) == sizeof(growth);
    ::_exit(told ? 0 : 1);
  }
  std::int64_t growth = -2;
  ::close(ends[1]);
  const bool heard = ::read(ends[0], &growth, sizeof(growth)) == sizeof(growth);
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return heard ? growth : -2;
}

class SkymapMemoryTest : public SkymapDamageTest {
 protected:
  void SetUp() override {
    if (testing::kSanitised) {
      GTEST_SKIP() << "a sanitiser takes memory of its own";
    }
  }

  /// The least limit with which a map is read must be more than it takes.
  void expect_within_limit(const SparseMap& map, std::uint64_t bricks, std::uint64_t mixed) const {
    const auto file = folder.path() / "large.skymap";
    write_skymap(file, map, {});
    std::uint64_t limit = 1U << 20U;
    while (!fits_in_memory(bricks, mixed, limit)) {
      limit += 1U << 20U;
    }
    EXPECT_EQ(growth_while_reading(file, limit - (2U << 20U)), -1);
    const std::int64_t growth = growth_while_reading(file, limit);
    EXPECT_GT(growth, static_cast<std::int64_t>(limit / 8));
    EXPECT_LT(growth, static_cast<std::int64_t>(limit) + (4 << 20));
  }
};

TEST_F(SkymapMemoryTest, ManyUniformBricksStayWithinTheLimit) {
  SparseMap map({.voxel_m = 0.1});
  constexpr int kBricks = 263'000;  // a little more than what the tables were last made for
  for (int i = 0; i < kBricks; ++i) {
    map.set_uniform({i % 64, i / 64 % 64, i / 4096}, -2000);
  }
  expect_within_limit(map, kBricks, 0);
}

TEST_F(SkymapMemoryTest, ManyMixedBricksStayWithinTheLimit) {
  SparseMap map({.voxel_m = 0.1});
  constexpr int kBricks = 33'000;
  for (int i = 0; i < kBricks; ++i) {
    map.set({i % 32 * 8, i / 32 % 32 * 8, i / 1024 * 8}, static_cast<LogOdds>(i));
  }
  expect_within_limit(map, kBricks, kBricks);
}

TEST_F(SkymapMemoryTest, ATinyFileOfManyBricksIsRefusedAtOnce) {
  SkymapBytes file;
  file.bricks = 10'000'000;
  file.unpacked_bytes = skymap::unpacked_bytes(file.bricks, 0);
  const auto written = folder.write("map.skymap", file.bytes());
  EXPECT_EQ(growth_while_reading(written, 1U << 30U), -1);
  EXPECT_THAT(refusal(file.bytes(), 1U << 30U), HasSubstr("more than 1024 MiB"));
  // It may, but has nothing behind it: no memory is taken on its word.
  EXPECT_THAT(refusal(file.bytes()), ::testing::AnyOf(HasSubstr("cut off"), HasSubstr("expected")));
}

}  // namespace
}  // namespace skyhalo
