#include "skyhalo/io/tile_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/map_cases.hpp"
#include "io/map_tiles_cases.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::difference;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;
using testing::tiles_lattice;

TEST(TileFilesTest, BricksLieInTilesOfEight) {
  EXPECT_EQ(tile_of({0, 7, 8}), Tile(0, 0, 1));
  EXPECT_EQ(tile_of({-1, -8, -9}), Tile(-1, -1, -2));
}

TEST(TileFilesTest, NamesAndTilesAreOneToOne) {
  for (const Tile& tile : {Tile(0, 0, 0), Tile(-1, 20, -300)}) {
    EXPECT_EQ(tile_named(tile_file_name(tile)), tile);
  }
  EXPECT_EQ(tile_file_name({-1, 20, -300}), "tile_-1_20_-300.skymap");
  for (const std::string name : {"",
                                 "tile",
                                 ".skymap",
                                 "tile.skymap",
                                 "tile_.skymap",
                                 "tile_1_2.skymap",
                                 "tile_1_2_3_4.skymap",
                                 "tile_1_2_3",
                                 "tile_01_2_3.skymap",
                                 "tile_-0_2_3.skymap",
                                 "tile_1_2_x.skymap",
                                 "tile_1_2_99999999999.skymap",
                                 "tile_1_2_3.skymap.damaged"}) {
    EXPECT_EQ(tile_named(name), std::nullopt) << name;
  }
}

/// Two tiles side by side, with a uniform and a mixed brick.
class TileFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    whole.set_uniform({0, 0, 0}, -800);
    write_skymap(first_file, whole, {.limit_units = 3000});
    SparseMap second(tiles_lattice());
    second.set({64, 0, 0}, 1500);
    write_skymap(second_file, second, {.limit_units = 4000});
    whole.set({64, 0, 0}, 1500);
  }

  TempFolder folder;
  fs::path first_file = folder.path() / "tile_0_0_0.skymap";
  fs::path second_file = folder.path() / "tile_1_0_0.skymap";
  SparseMap whole{tiles_lattice()};
};

TEST_F(TileFolderTest, AFolderIsOneMap) {
  (void)folder.write("notes.txt", "x");
  (void)folder.write("tile_5_0_0.skymap.damaged", "x");
  EXPECT_EQ(tiles_in(folder.path()), (std::vector<Tile>{{0, 0, 0}, {1, 0, 0}}));
  double last = 0.0;
  const Skymap read =
      read_tiles(folder.path(), kMapMemoryBytes, [&](double share) { last = share; });
  EXPECT_EQ(difference(read.map, whole), "");
  EXPECT_EQ(read.info.limit_units, 4000) << "the larger of both";
  EXPECT_EQ(last, 1.0);
}

TEST_F(TileFolderTest, TheHeadOfAFileIsReadAlone) {
  const SkymapHeader header = read_skymap_header(second_file);
  EXPECT_EQ(header.lattice, tiles_lattice());
  EXPECT_EQ(header.info.limit_units, 4000);
  EXPECT_EQ(header.bricks, 1U);
  EXPECT_EQ(header.mixed, 1U);
  EXPECT_EQ(read_skymap_header(first_file).mixed, 0U);
  fs::resize_file(second_file, 92);
  EXPECT_EQ(read_skymap_header(second_file).bricks, 1U);
  fs::resize_file(second_file, 91);
  EXPECT_THAT(message_of([&] { (void)read_skymap_header(second_file); }), HasSubstr("cut off"));
}

TEST_F(TileFolderTest, ADamagedTileIsNamedAndStays) {
  fs::resize_file(second_file, fs::file_size(second_file) - 1);
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path()); }),
              HasSubstr(second_file.string()));
  EXPECT_TRUE(fs::exists(second_file));
}

TEST_F(TileFolderTest, CellsOfAnotherTileAreRefused) {
  fs::copy_file(second_file, folder.path() / "tile_2_0_0.skymap");
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path()); }),
              ::testing::AllOf(HasSubstr("tile_2_0_0.skymap"), HasSubstr("another tile")));
}

TEST_F(TileFolderTest, MoreBricksThanATileHasAreRefused) {
  SparseMap large(tiles_lattice());
  for (int i = 0; i < 513; ++i) {
    large.set_uniform({i, 0, 0}, 100);
  }
  write_skymap(first_file, large, {});
  EXPECT_THAT(message_of([&] {
                (void)read_tile(folder.path(), {0, 0, 0});
              }),
              ::testing::AllOf(HasSubstr(first_file.string()), HasSubstr("more bricks")));
}

TEST_F(TileFolderTest, TilesOfAnotherMapAreRefused) {
  SparseMap other({.voxel_m = 0.5});
  other.set({128, 0, 0}, 100);
  write_skymap(folder.path() / "tile_2_0_0.skymap", other, {});
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path()); }),
              ::testing::AllOf(HasSubstr("tile_2_0_0.skymap"), HasSubstr("other cells")));
}

TEST_F(TileFolderTest, MemoryIsLimited) {
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path(), 1000); }),
              ::testing::AllOf(HasSubstr(folder.path().string()), HasSubstr("limit for reading")));
  EXPECT_NO_THROW((void)read_tiles(folder.path(), 2000));
}

TEST(TileFilesTest, AFolderWithoutTilesIsNoMap) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path()); }), HasSubstr("without tiles"));
  EXPECT_THAT(message_of([&] { (void)read_tiles(folder.path() / "none"); }), HasSubstr("none"));
}

}  // namespace
}  // namespace skyhalo
