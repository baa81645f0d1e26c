// `skyhalo run --tiles` as its users see it, on a small made-up drive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/config/config.hpp"
#include "skyhalo/io/folder_lock.hpp"
#include "skyhalo/io/text_file.hpp"
#include "skyhalo/io/tile_files.hpp"
#include "support/program.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProgramResult;
using testing::TempFolder;
using testing::write_text;

/// A drive of four frames, and a folder of tiles with a far place that it never sees.
class RunTilesSystem : public ::testing::Test {
 protected:
  void SetUp() override { data = testing::write_drive({}, root.path() / "data"); }

  [[nodiscard]] ProgramResult program(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, arguments, root.path());
  }

  [[nodiscard]] ProgramResult run(const Arguments& more) const {
    Arguments arguments{"run",
                        data.drive.string(),
                        "--out",
                        out.string(),
                        "--map",
                        "sparse",
                        "--tiles",
                        tiles.string(),
                        "--json",
                        "--set",
                        "matching.downscale=1",
                        "--set",
                        "matching.max_disparity_px=32",
                        "--set",
                        "matching.rcrop_px=16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return program(arguments);
  }

  /// Tiles 10 000 cells away with so many bricks of cells of their own, each about 1 KiB.
  void add_far_bricks(int bricks) const {
    fs::create_directories(tiles);
    SparseMap tile(lattice);
    const int first = 10'048 / kBrickEdge;  // where a tile begins
    for (int i = 0; i < bricks; ++i) {
      const Eigen::Vector3i brick(first + i, 0, 0);
      tile.set(first_cell(brick), 1000);
      if (i % kTileBricks == kTileBricks - 1 || i == bricks - 1) {
        write_skymap(tiles / tile_file_name(tile_of(brick)), tile, {});
        tile.clear();
      }
    }
  }

  [[nodiscard]] json summary() const {
    return json::parse(read_bytes(out / "summary.json"), nullptr, false);
  }

  TempFolder root;
  testing::DrivePaths data;
  fs::path out = root.path() / "out";
  fs::path tiles = root.path() / "tiles";
  VoxelLattice lattice{.origin_m = {0.0, 0.0, 0.0}, .voxel_m = Config{}.detector.map.voxel_m};
};

TEST_F(RunTilesSystem, AMapThatKeepsToTheBudgetIsWrittenWhole) {
  add_far_bricks(20);
  const ProgramResult r = run({});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.err, IsEmpty());
  for (const char* const name : {"map.ply", "map.ot", "map.skymap", "trajectory.tum"}) {
    EXPECT_TRUE(fs::exists(out / name)) << name;
  }
  EXPECT_EQ(summary()["tiles"]["map_files"], true);
  EXPECT_EQ(summary()["tiles"]["damaged"], 0);
  EXPECT_EQ(summary()["tiles"]["folder"], tiles.string());
  EXPECT_EQ(read_skymap(out / "map.skymap").map.at({10'048, 0, 0}), 1000);
}

TEST_F(RunTilesSystem, AMapLargerThanTheBudgetStaysInItsFolder) {
  add_far_bricks(1100);
  write_text(out / "map.skymap", "of an earlier run");
  write_text(out / "notes.txt", "mine");
  const ProgramResult r = run({"--set", "map.memory_mib=1"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.out, Not(HasSubstr("map.skymap, trajectory")));
  for (const char* const name : {"map.ply", "map.ot", "map.skymap"}) {
    EXPECT_FALSE(fs::exists(out / name)) << name;
  }
  EXPECT_TRUE(fs::exists(out / "trajectory.tum"));
  EXPECT_TRUE(fs::exists(out / "notes.txt"));
  EXPECT_EQ(summary()["tiles"]["map_files"], false);
  EXPECT_GT(summary()["tiles"]["whole_map_mib"], 1.0);
  const std::string command = "skyhalo map convert " + tiles.string() + " map.skymap";
  EXPECT_EQ(summary()["tiles"]["command_for_one_file"], command);
  EXPECT_THAT(r.err, AllOf(HasSubstr("map.memory_mib (1)"), HasSubstr(command)));
  // The command does what it says, and the map is the one of a run with more memory.
  const std::string one_file = (root.path() / "one.skymap").string();
  ASSERT_EQ(program({"map", "convert", tiles.string(), one_file}).exit_code, 0);
  fs::remove_all(tiles);
  add_far_bricks(1100);
  ASSERT_EQ(run({}).exit_code, 0);
  EXPECT_TRUE(read_bytes(one_file) == read_bytes(out / "map.skymap"));
}

TEST_F(RunTilesSystem, ADamagedTileDoesNotEndTheRun) {
  write_text(tiles / "tile_0_0_0.skymap", "damaged");
  const ProgramResult r = run({});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const std::string aside = (tiles / "tile_0_0_0.skymap.damaged").string();
  EXPECT_EQ(read_bytes(aside), "damaged");
  EXPECT_THAT(r.err, AllOf(HasSubstr("warning"), HasSubstr(aside)));
  EXPECT_EQ(r.err.find(aside), r.err.rfind(aside)) << "told once";
  EXPECT_EQ(summary()["tiles"]["damaged"], 1);
  EXPECT_EQ(summary()["tiles"]["set_aside"], json({aside}));
  EXPECT_FALSE(read_tiles(tiles).map.bricks().empty()) << "the space is mapped anew";
}

TEST_F(RunTilesSystem, AFolderThatAnotherRunUsesIsRefused) {
  fs::create_directories(tiles);
  const FolderLock other_run(tiles);
  const ProgramResult r = run({});
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.out, IsEmpty());
  EXPECT_THAT(r.err, AllOf(HasSubstr(tiles.string()), HasSubstr("in use")));
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(RunTilesSystem, TilesOfOtherCellsAreRefusedAndLeftAsTheyAre) {
  add_far_bricks(1);
  const ProgramResult r = run({"--set", "map.voxel_m=0.1"});
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err, AllOf(HasSubstr("other cells"), Not(HasSubstr("set aside"))));
  EXPECT_EQ(tiles_in(tiles).size(), 1U);
}

}  // namespace
}  // namespace skyhalo
