// `skyhalo map` as its users see it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/octomap_file.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::operator+;
using testing::ProgramResult;
using testing::TempFolder;

/// Two maps of half a metre: `a` with a wall of 3 cells and a free brick, `b` with a part of it.
class MapCommandSystem : public ::testing::Test {
 protected:
  void SetUp() override {
    SparseMap first({.origin_m = {1.0, 0.0, 0.0}, .voxel_m = 0.5});
    first.set_uniform({0, 0, 0}, -1000);
    for (const int y : {10, 11, 12}) {
      first.set({9, y, 1}, 3000);
    }
    SparseMap second({.origin_m = {0.0, 0.0, 0.0}, .voxel_m = 0.5});  // two cells further left
    second.set({11, 10, 1}, 3000);
    second.set({11, 11, 1}, -500);
    write_skymap(a, first, {.limit_units = 4000});
    write_skymap(b, second, {.limit_units = 5000});
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder.path() / name).string();
  }

  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, Arguments{"map"} + arguments, logs.path());
  }

  /// The summary of a run that ends well.
  [[nodiscard]] json summary(const Arguments& arguments) const {
    const ProgramResult result = run(arguments + Arguments{"--json", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, IsEmpty());
    return json::parse(result.out, nullptr, false);
  }

  void expect_refused(const Arguments& arguments,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
  }

  TempFolder folder;
  TempFolder logs;
  std::string a = path("a.skymap");
  std::string b = path("b.skymap");
};

// --- info

TEST_F(MapCommandSystem, InfoSaysWhatAMapHolds) {
  const json map = summary({"info", a});
  EXPECT_EQ(map["file"], a);
  EXPECT_EQ(map["format"], "skymap");
  EXPECT_EQ(map["voxel_m"], 0.5);
  EXPECT_EQ(map["origin_m"], json({1.0, 0.0, 0.0}));
  EXPECT_EQ(map["bricks"], 2);
  EXPECT_EQ(map["uniform_bricks"], 1);
  EXPECT_EQ(map["known_cells"], 515);
  EXPECT_EQ(map["free_cells"], 512);
  EXPECT_EQ(map["occupied_cells"], 3);
  EXPECT_EQ(map["min_m"], json({1.0, 0.0, 0.0}));
  EXPECT_EQ(map["max_m"], json({6.0, 6.5, 4.0}));
  EXPECT_EQ(map["lowest_log_odds"], -1.0);
  EXPECT_EQ(map["highest_log_odds"], 3.0);
  EXPECT_EQ(map["log_odds_limit"], 4.0);
  EXPECT_EQ(map["file_bytes"], fs::file_size(a));
  EXPECT_GT(map["memory_bytes"], 1024);
  const ProgramResult text = run({"info", a, b});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out,
              AllOf(HasSubstr(a), HasSubstr(b), HasSubstr("515 known cells"), HasSubstr("0.5 m")));
  EXPECT_EQ(summary({"info", a, b})["maps"].size(), 2U);
}

TEST_F(MapCommandSystem, InfoGoesByTheSettings) {
  // Log odds of 3 are a probability of 0.953.
  EXPECT_EQ(summary({"info", a, "--set", "evaluation.occupied_probability=0.96"})["occupied_cells"],
            0);
}

TEST_F(MapCommandSystem, AnEmptyMapIsDescribed) {
  write_skymap(a, SparseMap({.voxel_m = 0.5}), {});
  const json map = summary({"info", a});
  EXPECT_EQ(map["known_cells"], 0);
  EXPECT_TRUE(map["min_m"].is_null());
  EXPECT_EQ(run({"info", a}).exit_code, 0);
}

// --- convert

TEST_F(MapCommandSystem, MapsGoThroughOctomapAndBack) {
  const json written = summary({"convert", a, path("m.ot")});
  EXPECT_EQ(written["out"], path("m.ot"));
  EXPECT_EQ(written["occupied_cells"], 3);
  EXPECT_EQ(summary({"convert", path("m.ot"), path("back.skymap")})["known_cells"], 515);
  // The origin, 2 cells, has gone into the numbers of the cells.
  const SparseMap back = read_skymap(path("back.skymap")).map;
  EXPECT_EQ(back.lattice(), (VoxelLattice{.voxel_m = 0.5}));
  EXPECT_EQ(back.at({11, 10, 1}), 3000);
  EXPECT_EQ(back.at({2, 0, 0}), -1000);
  EXPECT_EQ(back.at({9, 7, 7}), -1000);
  EXPECT_EQ(back.at({1, 0, 0}), kUnknown);
  (void)summary({"convert", path("m.ot"), path("m.BT")});
  EXPECT_EQ(read_octomap(path("m.BT"), OctreeForm::kBinary).at({11, 10, 1}), 3511);
}

TEST_F(MapCommandSystem, TheLimitGoesOnOrComesFromTheSettings) {
  (void)summary({"convert", a, path("copy.skymap")});
  EXPECT_EQ(read_bytes(path("copy.skymap")), read_bytes(a));
  (void)summary({"convert", a, path("m.ot")});
  (void)summary({"convert", path("m.ot"), path("m.skymap"), "--set", "map.log_odds_limit=3.5"});
  EXPECT_EQ(read_skymap(path("m.skymap")).info.limit_units, 3500);
}

TEST_F(MapCommandSystem, PointsAreWritten) {
  (void)summary({"convert", a, path("m.ply")});
  (void)summary({"convert", a, path("m.pcd")});
  EXPECT_THAT(read_bytes(path("m.ply")), HasSubstr("element vertex 3\n"));
  EXPECT_THAT(read_bytes(path("m.pcd")), HasSubstr("POINTS 3\n"));
}

TEST_F(MapCommandSystem, ASliceIsAPictureAndItsYaml) {
  const ProgramResult result = run({"convert", a, path("floor.yaml"), "--slice", "0.5:1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("floor.png"), HasSubstr("floor.yaml")));
  const cv::Mat image = read_image(path("floor.png"));
  // Columns 0 to 9, rows 0 to 12.
  ASSERT_EQ(image.size(), cv::Size(10, 13));
  EXPECT_EQ(image.at<unsigned char>(0, 9), 0);
  EXPECT_EQ(image.at<unsigned char>(12, 0), 254);
  EXPECT_THAT(read_bytes(path("floor.yaml")), HasSubstr("origin: [1, 0, 0]"));
}

TEST_F(MapCommandSystem, AFileMayBeReplacedByItsOwnConversion) {
  const std::string before = read_bytes(a);
  (void)summary({"convert", a, a});
  EXPECT_EQ(read_bytes(a), before);
}

TEST_F(MapCommandSystem, TheTextNamesTheFile) {
  const ProgramResult result = run({"convert", a, path("m.ot")});
  EXPECT_THAT(result.out, AllOf(HasSubstr("515 known cells"), HasSubstr(path("m.ot"))));
  EXPECT_THAT(result.err, IsEmpty()) << "a bar is for terminals";
  const ProgramResult quiet = run({"convert", a, path("m.ot"), "--quiet"});
  EXPECT_THAT(quiet.out + quiet.err, IsEmpty());
}

// --- folders of tiles

TEST_F(MapCommandSystem, AFolderOfTilesIsAMap) {
  fs::create_directory(path("tiles"));
  fs::copy_file(a, path("tiles/tile_0_0_0.skymap"));
  SparseMap far({.origin_m = {1.0, 0.0, 0.0}, .voxel_m = 0.5});
  far.set({64, 0, 0}, 1500);
  write_skymap(path("tiles/tile_1_0_0.skymap"), far, {.limit_units = 4000});
  const json map = summary({"info", path("tiles")});
  EXPECT_EQ(map["format"], "tiles");
  EXPECT_EQ(map["known_cells"], 516);
  EXPECT_EQ(map["log_odds_limit"], 4.0);
  EXPECT_EQ(map["file_bytes"],
            fs::file_size(path("tiles/tile_0_0_0.skymap")) +
                fs::file_size(path("tiles/tile_1_0_0.skymap")));
  EXPECT_EQ(summary({"convert", path("tiles"), path("m.skymap")})["known_cells"], 516);
  EXPECT_EQ(summary({"compare", path("tiles"), path("m.skymap")})["largest_difference"], 0.0);
  EXPECT_EQ(summary({"merge", path("sum.skymap"), path("tiles"), b})["known_cells"], 516);
}

TEST_F(MapCommandSystem, ADamagedTileIsNamedAndLeftAsItIs) {
  fs::create_directory(path("tiles"));
  expect_refused({"info", path("tiles")}, 3, {path("tiles"), "without tiles"});
  fs::copy_file(a, path("tiles/tile_0_0_0.skymap"));
  fs::resize_file(path("tiles/tile_0_0_0.skymap"), fs::file_size(a) - 1);
  for (const Arguments& arguments :
       {Arguments{"info", path("tiles")}, Arguments{"convert", path("tiles"), path("m.ot")}}) {
    expect_refused(arguments, 3, {path("tiles/tile_0_0_0.skymap")});
  }
  EXPECT_TRUE(fs::exists(path("tiles/tile_0_0_0.skymap")));
  EXPECT_FALSE(fs::exists(path("m.ot")));
}

// --- merge

TEST_F(MapCommandSystem, MergedLogOddsAddAndStayWithinTheLimit) {
  const json written = summary({"merge", path("m.skymap"), a, b});
  EXPECT_EQ(written["in"], json({a, b}));
  EXPECT_EQ(written["log_odds_limit"], 5.0);
  const Skymap merged = read_skymap(path("m.skymap"));
  EXPECT_EQ(merged.info.limit_units, 5000) << "the larger of both";
  EXPECT_EQ(merged.map.lattice().origin_m.x(), 1.0) << "the first map's";
  EXPECT_EQ(merged.map.at({9, 10, 1}), 5000);
  EXPECT_EQ(merged.map.at({9, 11, 1}), 2500);
  EXPECT_EQ(merged.map.at({9, 12, 1}), 3000);
  EXPECT_EQ(merged.map.at({0, 0, 0}), -1000);
}

TEST_F(MapCommandSystem, MoreThanTwoAreMergedIntoAnyFormat) {
  EXPECT_EQ(summary({"merge", path("m.ply"), a, b, a, b})["occupied_cells"], 3);
  EXPECT_EQ(summary({"merge", path("m.png"), a, b, "--slice", "0:1"})["occupied_cells"], 3);
}

TEST_F(MapCommandSystem, OtherCellsAreNotMerged) {
  write_skymap(path("fine.skymap"), SparseMap({.voxel_m = 0.25}), {});
  write_skymap(path("aside.skymap"), SparseMap({.origin_m = {0.1, 0.0, 0.0}, .voxel_m = 0.5}), {});
  expect_refused({"merge", path("m.skymap"), a, path("fine.skymap")},
                 3,
                 {a, path("fine.skymap"), "0.5 m and 0.25 m"});
  expect_refused({"merge", path("m.skymap"), a, path("aside.skymap")}, 3, {"whole cells"});
  EXPECT_FALSE(fs::exists(path("m.skymap")));
}

// --- compare

TEST_F(MapCommandSystem, MapsAreCompared) {
  const json found = summary({"compare", a, b});
  EXPECT_EQ(found["cells"]["occupied"]["occupied"], 1);
  EXPECT_EQ(found["cells"]["occupied"]["free"], 1);
  EXPECT_EQ(found["cells"]["occupied"]["unknown"], 1);
  EXPECT_EQ(found["cells"]["free"]["unknown"], 512);
  EXPECT_EQ(found["cells"]["unknown"]["free"], 0);
  EXPECT_EQ(found["known_in_both"], 2);
  EXPECT_NEAR(found["occupied_intersection_over_union"].get<double>(), 1.0 / 3.0, 1e-12);
  EXPECT_TRUE(found["correlation"].is_null()) << "the first map's two cells are equal";
  EXPECT_EQ(found["largest_difference"], 3.5);
  EXPECT_EQ(found["largest_difference_at_m"], json({5.75, 5.75, 0.75}));
  const ProgramResult text = run({"compare", a, b});
  EXPECT_THAT(text.out,
              AllOf(HasSubstr("occupied"),
                    HasSubstr("512"),
                    HasSubstr("union 0.3333"),
                    HasSubstr("difference 3.5")));
  EXPECT_THAT(run({"compare", a, b, "--quiet"}).out, IsEmpty());
}

TEST_F(MapCommandSystem, AMapEqualsItsConversion) {
  (void)summary({"convert", a, path("m.ot")});
  const json found = summary({"compare", a, path("m.ot")});
  EXPECT_EQ(found["known_in_both"], 515);
  EXPECT_EQ(found["largest_difference"], 0.0);
  EXPECT_EQ(found["occupied_intersection_over_union"], 1.0);
}

// --- what is wrong

TEST_F(MapCommandSystem, WrongUsageEndsWithTwo) {
  expect_refused({}, 2, {"subcommand"});
  expect_refused({"info"}, 2, {"FILES"});
  expect_refused({"convert", a}, 2, {"OUT"});
  expect_refused({"merge", path("m.skymap"), a}, 2, {"FILES"});
  expect_refused({"compare", a}, 2, {"B"});
  expect_refused({"convert", a, path("m.txt")}, 2, {path("m.txt"), ".skymap"});
  expect_refused({"convert", a, path("m")}, 2, {".skymap"});
  expect_refused({"convert", a, path("m.png")}, 2, {"--slice Z0:Z1"});
  expect_refused({"convert", a, path("m.ot"), "--slice", "0:1"}, 2, {"--slice", "no slice"});
  for (const std::string slice : {"1", "1:", ":1", "2:1", "a:b", "0:nan"}) {
    expect_refused({"convert", a, path("m.png"), "--slice", slice}, 2, {"--slice " + slice});
  }
  expect_refused({"info", a, "--max-memory-mib", "0"}, 2, {"--max-memory-mib"});
  expect_refused({"info", a, "--colour"}, 2, {"--colour"});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

TEST_F(MapCommandSystem, BadInputEndsWithThree) {
  expect_refused({"info", path("none.skymap")}, 3, {path("none.skymap"), "no such file"});
  expect_refused({"info", folder.write("m.txt", "").string()}, 3, {"m.txt", "expected .skymap"});
  for (const std::string name : {"m.ply", "m.pcd", "m.png"}) {
    expect_refused({"convert", folder.write(name, "x").string(), path("o.skymap")},
                   3,
                   {path(name), "picture of a map", "cannot be read back"});
  }
  fs::resize_file(b, 100);
  expect_refused({"convert", b, path("o.skymap")}, 3, {b, "cut off"});
  expect_refused({"merge", path("o.skymap"), a, b}, 3, {b, "cut off"});
  expect_refused({"convert", a, path("o.png"), "--slice", "50:60"}, 3, {"50 m and 60 m"});
  expect_refused({"info", a, "--set", "map.none=1"}, 3, {"map.none"});
  EXPECT_FALSE(fs::exists(path("o.skymap")));
}

TEST_F(MapCommandSystem, MemoryIsLimited) {
  SparseMap map({.voxel_m = 0.5});
  for (int i = 0; i < 10'000; ++i) {
    map.set_uniform({i, 0, 0}, -1000);
  }
  write_skymap(a, map, {});
  expect_refused({"info", a, "--max-memory-mib", "1"}, 3, {a, "more than 1 MiB"});
  EXPECT_EQ(summary({"info", a, "--max-memory-mib", "2"})["bricks"], 10'000);
}

TEST_F(MapCommandSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  expect_refused({"convert", a, path("none/m.skymap")}, 1, {path("none/m.skymap")});
  expect_refused({"convert", a, path("none/m.ply")}, 1, {path("none/m.ply")});
  SparseMap far({.voxel_m = 0.5});
  far.set({100'000, 0, 0}, 100);
  write_skymap(a, far, {});
  expect_refused({"convert", a, path("m.ot")}, 1, {path("m.ot"), "octree"});
}

TEST_F(MapCommandSystem, AFailureLeavesTheEarlierFile) {
  (void)folder.write("m.ot", "earlier");
  SparseMap far({.voxel_m = 0.5});
  far.set({100'000, 0, 0}, 100);
  write_skymap(a, far, {});
  EXPECT_EQ(run({"convert", a, path("m.ot")}).exit_code, 1);
  EXPECT_EQ(read_bytes(path("m.ot")), "earlier");
}

TEST_F(MapCommandSystem, HelpExplainsTheFormats) {
  for (const std::string command : {"info", "convert", "merge", "compare"}) {
    const ProgramResult result = run({command, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    for (const std::string word : {".skymap", ".ot", ".bt", "--json", "--max-memory-mib"}) {
      EXPECT_THAT(result.out, HasSubstr(word)) << command;
    }
  }
  EXPECT_THAT(run({"convert", "--help"}).out,
              AllOf(HasSubstr("--slice"), HasSubstr("map_server"), HasSubstr(".pcd")));
}

}  // namespace
}  // namespace skyhalo
