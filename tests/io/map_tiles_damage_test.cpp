// Tiles that are damaged or cannot be written, and programs that are killed while they save some.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <limits>
#include <new>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "io/map_cases.hpp"
#include "io/map_tiles_cases.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/io/map_tiles.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::difference;
using ::testing::HasSubstr;
using testing::message_of;
using testing::no_budget;
using testing::TempFolder;
using testing::tiles_lattice;
using testing::Wanderer;

/// Far away from what the maps here know, and in the midst of it.
const Eigen::Vector3d kFarM(900.0, 0.0, 0.0);
const Eigen::Vector3d kNearM(1.0, 1.0, 1.0);

/// Two tiles, one on each side of x = 0.5 m, and values of a brick of each.
SparseMap two_tiles() {
  SparseMap map(tiles_lattice());
  map.set({3, 3, 3}, 1500);
  map.set({-3, 3, 3}, -700);
  return map;
}

class MapTilesDamageTest : public ::testing::Test {
 protected:
  /// Changes a bit in the midst of a file; returns what it holds now.
  [[nodiscard]] static std::string damage(const fs::path& file) {
    std::string bytes = read_bytes(file);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
    write_bytes(file, bytes);
    return bytes;
  }

  TempFolder temp;
  fs::path folder = temp.path() / "tiles";
  fs::path first_tile = folder / "tile_0_0_0.skymap";
};

TEST_F(MapTilesDamageTest, ADamagedTileIsSetAsideAndTheFlightGoesOn) {
  SparseMap map = two_tiles();
  MapTiles tiles(folder, no_budget());
  tiles.follow(kFarM, map);
  ASSERT_EQ(map.brick_count(), 0U);
  const std::string bytes = damage(first_tile);
  tiles.follow(kNearM, map);
  EXPECT_EQ(map.at({3, 3, 3}), kUnknown);
  EXPECT_EQ(map.at({-3, 3, 3}), -700) << "the tile beside it is whole";
  ASSERT_EQ(tiles.damaged().size(), 1U);
  EXPECT_THAT(tiles.damaged()[0].problem, HasSubstr(first_tile.string()));
  EXPECT_EQ(tiles.damaged()[0].set_aside, first_tile.string() + ".damaged");
  EXPECT_FALSE(fs::exists(first_tile));
  EXPECT_EQ(read_bytes(tiles.damaged()[0].set_aside), bytes);
  // The flight maps that space anew.
  map.set({4, 4, 4}, 900);
  tiles.follow(kFarM, map);
  tiles.follow(kNearM, map);
  EXPECT_EQ(map.at({4, 4, 4}), 900);
  tiles.flush(map);
  EXPECT_EQ(tiles.damaged().size(), 1U) << "told once";
  EXPECT_EQ(difference(read_tiles(folder).map, map), "");
  EXPECT_EQ(read_bytes(tiles.damaged()[0].set_aside), bytes);
}

TEST_F(MapTilesDamageTest, WhatAScanSawOfADamagedTileStays) {
  for (const bool by_flush : {true, false}) {
    fs::remove_all(folder);
    SparseMap map = two_tiles();
    MapTiles tiles(folder, no_budget());
    tiles.follow(kFarM, map);
    (void)damage(first_tile);
    map.set({4, 4, 4}, 900);
    if (by_flush) {
      tiles.flush(map);
      EXPECT_EQ(map.at({4, 4, 4}), 900);
    } else {
      tiles.follow(kFarM, map);
      EXPECT_EQ(map.brick_count(), 0U) << "it is put out again";
    }
    EXPECT_EQ(tiles.damaged().size(), 1U);
    EXPECT_EQ(read_tiles(folder).map.at({4, 4, 4}), 900);
    EXPECT_TRUE(fs::exists(first_tile.string() + ".damaged"));
  }
}

TEST_F(MapTilesDamageTest, DamagedTilesNeverReplaceEachOther) {
  (void)temp.write("tiles/tile_0_0_0.skymap.damaged", "first");
  (void)temp.write("tiles/tile_0_0_0.skymap.damaged-2", "second");
  (void)temp.write("tiles/tile_0_0_0.skymap", "third");
  SparseMap map(tiles_lattice());
  MapTiles tiles(folder, no_budget());
  tiles.follow(kNearM, map);
  EXPECT_EQ(map.brick_count(), 0U);
  EXPECT_EQ(read_bytes(folder / "tile_0_0_0.skymap.damaged"), "first");
  EXPECT_EQ(read_bytes(folder / "tile_0_0_0.skymap.damaged-2"), "second");
  EXPECT_EQ(read_bytes(folder / "tile_0_0_0.skymap.damaged-3"), "third");
  EXPECT_EQ(tiles.away_count(), 0U);
}

TEST_F(MapTilesDamageTest, EveryKindOfDamageIsSetAside) {
  SparseMap map = two_tiles();
  { MapTiles(folder, no_budget()).flush(map); }
  const std::string whole = read_bytes(first_tile);
  const std::string of_another_tile = read_bytes(folder / "tile_-1_0_0.skymap");
  for (const std::string& bytes :
       {std::string(), whole.substr(0, 50), whole.substr(0, whole.size() - 1), of_another_tile}) {
    (void)temp.write("tiles/tile_0_0_0.skymap", bytes);
    MapTiles tiles(folder, no_budget());
    SparseMap again(tiles_lattice());
    EXPECT_NO_THROW(tiles.bring_in_all(again));
    EXPECT_EQ(tiles.damaged().size(), 1U);
    EXPECT_EQ(again.brick_count(), 1U);
    EXPECT_EQ(again.at({-3, 3, 3}), -700);
  }
}

/// Takes all file handles that this program may have.
class AllFileHandles {
 public:
  AllFileHandles() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    rlimit few = before_;
    few.rlim_cur = 64;
    ::setrlimit(RLIMIT_NOFILE, &few);
    // Not copies of standard input: a program may have been started without one. No sanitiser must
    // want a handle: the one that looks at the type behind a vptr does, so builds leave it out.
    const auto take = [] { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); };
    for (int handle = take(); handle >= 0; handle = take()) {
      taken_.push_back(handle);
    }
  }

  ~AllFileHandles() {
    for (const int handle : taken_) {
      ::close(handle);
    }
    ::setrlimit(RLIMIT_NOFILE, &before_);
  }

  AllFileHandles(const AllFileHandles&) = delete;
  AllFileHandles& operator=(const AllFileHandles&) = delete;
  AllFileHandles(AllFileHandles&&) = delete;
  AllFileHandles& operator=(AllFileHandles&&) = delete;

 private:
  rlimit before_{};
  std::vector<int> taken_;
};

TEST_F(MapTilesDamageTest, ATileThatCannotBeReadNowIsNotDamaged) {
  SparseMap map = two_tiles();
  MapTiles tiles(folder, no_budget());
  tiles.follow(kFarM, map);
  {
    const AllFileHandles all;
    EXPECT_THROW(tiles.bring_in_all(map), Error);
  }
  EXPECT_TRUE(fs::exists(first_tile));
  EXPECT_TRUE(tiles.damaged().empty());
  tiles.bring_in_all(map);
  EXPECT_EQ(map.brick_count(), 2U);
}

TEST_F(MapTilesDamageTest, ATileThatIsGoneIsToldToo) {
  SparseMap map = two_tiles();
  MapTiles tiles(folder, no_budget());
  tiles.follow(kFarM, map);
  fs::remove(first_tile);
  tiles.bring_in_all(map);
  ASSERT_EQ(tiles.damaged().size(), 1U);
  EXPECT_THAT(tiles.damaged()[0].problem, HasSubstr("no such file"));
  EXPECT_EQ(tiles.damaged()[0].set_aside, "");
  EXPECT_EQ(map.brick_count(), 1U);
}

TEST_F(MapTilesDamageTest, ATileOfAnotherMapAnywhereIsRefusedBeforeAnythingChanges) {
  SparseMap map = two_tiles();
  { MapTiles(folder, no_budget()).flush(map); }
  SparseMap other({.origin_m = {0.0, 0.0, 0.0}, .voxel_m = 0.25});
  other.set({64 * 50, 0, 0}, 100);
  write_skymap(folder / "tile_50_0_0.skymap", other, {});
  MapTiles tiles(folder, no_budget());
  SparseMap again(tiles_lattice());
  EXPECT_THAT(message_of([&] { tiles.follow(kNearM, again); }), HasSubstr("tile_50_0_0"));
  EXPECT_EQ(again.brick_count(), 0U);
  EXPECT_TRUE(tiles.damaged().empty());
}

TEST_F(MapTilesDamageTest, ATileOfAnotherLatticeIsRefused) {
  SparseMap map = two_tiles();
  { MapTiles(folder, no_budget()).flush(map); }
  SparseMap other({.origin_m = {0.0, 0.0, 0.0}, .voxel_m = 0.25});
  MapTiles again(folder, no_budget());
  EXPECT_THAT(message_of([&] { again.bring_in_all(other); }), HasSubstr("tile_"));
  EXPECT_EQ(other.brick_count(), 0U);
  EXPECT_TRUE(again.damaged().empty());
}

TEST_F(MapTilesDamageTest, WhatCannotBeWrittenStaysInTheMap) {
  SparseMap map = two_tiles();
  MapTiles tiles(folder, no_budget());
  fs::remove_all(folder);
  const SparseMap before = map;
  (void)message_of([&] { tiles.flush(map); }, ErrorKind::kFailure);
  EXPECT_EQ(difference(map, before), "");
  (void)message_of([&] { tiles.follow(kFarM, map); }, ErrorKind::kFailure);
  EXPECT_EQ(difference(map, before), "");
  fs::create_directories(folder);
  tiles.follow(kFarM, map);
  EXPECT_EQ(map.brick_count(), 0U);
  tiles.bring_in_all(map);
  EXPECT_EQ(difference(map, before), "");
}

TEST_F(MapTilesDamageTest, AFolderThatCannotBeMadeIsAFailure) {
  const fs::path file = temp.write("file", "x");
  EXPECT_THAT(message_of([&] { MapTiles(file / "tiles", no_budget()); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
}

TEST_F(MapTilesDamageTest, RefusesSettingsOutsideTheirDomain) {
  for (const double reach_m : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    (void)message_of([&] { MapTiles(folder, {.reach_m = reach_m}); });
  }
  for (const int limit_units : {0, -1, 32768}) {
    (void)message_of([&] { MapTiles(folder, {.limit_units = limit_units}); });
  }
}

TEST_F(MapTilesDamageTest, APositionThatIsNotFiniteMovesNothing) {
  SparseMap map = two_tiles();
  MapTiles tiles(folder, no_budget());
  tiles.follow({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, map);
  tiles.follow({std::numeric_limits<double>::infinity(), 0.0, 0.0}, map);
  EXPECT_EQ(difference(map, two_tiles()), "");
}

/// A flight that is killed: only increments of 1 or more, so that cells never fall.
class KilledFlight {
 public:
  static constexpr int kFrames = 400;
  static constexpr int kFramesPerFlush = 4;
  static constexpr MapTilesConfig kTiles{
      .budget_bytes = 20000, .reach_m = 10.0, .limit_units = Wanderer::kLimit};

  explicit KilledFlight(unsigned seed) : drone_(seed, 1, 9) {}

  /// A frame of the map alone.
  void fly(SparseMap& map) {
    drone_.fly();
    SparseMap unused(tiles_lattice());
    drone_.see(9.0, map, unused);
  }

  /// All of it with tiles, up to the end or the kill; counts the flushes that have returned.
  void run(const fs::path& folder, std::atomic<int>& flushes) {
    SparseMap map(tiles_lattice());
    SparseMap unused(tiles_lattice());
    MapTiles tiles(folder, kTiles);
    for (int frame = 1; frame <= kFrames; ++frame) {
      drone_.fly();
      tiles.follow(drone_.position_m(), map);
      drone_.see(9.0, map, unused);
      if (frame % kFramesPerFlush == 0) {
        tiles.flush(map);
        ++flushes;
      }
    }
  }

 private:
  Wanderer drone_;
};

/// A number that a child process shares with this one.
class SharedCount {
 public:
  SharedCount()
      : memory_(::mmap(nullptr,
                       sizeof(std::atomic<int>),
                       PROT_READ | PROT_WRITE,
                       MAP_SHARED | MAP_ANONYMOUS,
                       -1,
                       0)),
        count_(new (memory_) std::atomic<int>(0)) {}

  SharedCount(const SharedCount&) = delete;
  SharedCount(SharedCount&&) = delete;
  SharedCount& operator=(const SharedCount&) = delete;
  SharedCount& operator=(SharedCount&&) = delete;

  ~SharedCount() { ::munmap(memory_, sizeof(std::atomic<int>)); }

  std::atomic<int>& operator*() { return *count_; }

 private:
  void* memory_;
  std::atomic<int>* count_;
};

/// Lets a child fly until it has flushed some times and a while longer, and kills it. Returns how
/// many flushes it had done.
int fly_and_kill(KilledFlight flight,
                 const fs::path& folder,
                 int least_flushes,
                 std::chrono::microseconds longer) {
  SharedCount flushes;
  const pid_t child = ::fork();
  if (child == 0) {
    flight.run(folder, *flushes);
    ::_exit(0);
  }
  int status = 0;
  while (*flushes < least_flushes && ::waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::yield();
  }
  std::this_thread::sleep_for(longer);
  ::kill(child, SIGKILL);
  (void)::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it came to its end";
  return *flushes;
}

/// Cells whose value in the folder is none that they had between two states, or that it lacks.
int wrong_cells(const SparseMap& saved, const SparseMap& from, const SparseMap& to) {
  const auto units = [](LogOdds cell) { return cell == kUnknown ? 0 : int{cell}; };
  int wrong = 0;
  for (const Eigen::Vector3i& brick : to.bricks()) {
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      const Eigen::Vector3i cell = cell_in_brick(brick, place);
      const int value = units(saved.at(cell));
      wrong += value >= units(from.at(cell)) && value <= units(to.at(cell)) ? 0 : 1;
    }
  }
  for (const Eigen::Vector3i& brick : saved.bricks()) {
    wrong += to.holds_brick(brick) ? 0 : 1;
  }
  return wrong;
}

TEST(MapTilesKillTest, AKillLosesAtMostWhatCameAfterTheLastFlush) {
  std::mt19937 random(51);
  int later = 0;
  int saved_bricks = 0;
  for (unsigned round = 0; round < 40; ++round) {
    const TempFolder temp;
    const auto longer = std::chrono::microseconds(random() % 10000U);
    const int flushes =
        fly_and_kill(KilledFlight(round), temp.path(), static_cast<int>(random() % 6U), longer);
    // The same flight without tiles: at the last flush, and just before the end of the next one.
    SparseMap at_flush(tiles_lattice());
    KilledFlight flight(round);
    for (int frame = 0; frame < flushes * KilledFlight::kFramesPerFlush; ++frame) {
      flight.fly(at_flush);
    }
    SparseMap at_next = at_flush;
    for (int frame = 0; frame < 2 * KilledFlight::kFramesPerFlush; ++frame) {
      flight.fly(at_next);
    }
    SparseMap saved(tiles_lattice());
    MapTiles tiles(temp.path(), KilledFlight::kTiles);
    ASSERT_NO_THROW(tiles.bring_in_all(saved)) << "round " << round;
    ASSERT_TRUE(tiles.damaged().empty()) << tiles.damaged()[0].problem;
    ASSERT_EQ(wrong_cells(saved, at_flush, at_next), 0)
        << "round " << round << ", after " << flushes << " flushes";
    later += difference(saved, at_flush).empty() ? 0 : 1;
    saved_bricks += static_cast<int>(saved.brick_count());
  }
  EXPECT_GT(later, 3) << "no kill came while something was written: nothing was tried";
  EXPECT_GT(saved_bricks, 500);
  RecordProperty("killed_while_writing", later);
}

}  // namespace
}  // namespace skyhalo
