// The program as its users see it: exit codes, files, stdout and stderr, on a small made-up drive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "skyhalo/config/config.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using testing::operator+;
using testing::DrivePaths;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::label_line;
using ::testing::Not;
using testing::Program;
using testing::ProgramResult;
using testing::run_program;
using testing::SyntheticDrive;
using testing::TempFolder;
using testing::write_drive;
using testing::write_text;

/// Settings that suit the small pictures: a search of 32 pixels at full resolution.
const Arguments kSmallPictures{"--set",
                               "matching.downscale=1",
                               "--set",
                               "matching.max_disparity_px=32",
                               "--set",
                               "matching.rcrop_px=16"};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A drive of four frames in a folder of its own, and a place for results.
class CommandLineSystem : public ::testing::Test {
 protected:
  void SetUp() override { data = write_drive(world, root.path() / "data"); }

  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return run_program(SKYHALO_PROGRAM, arguments, root.path());
  }

  /// `evaluate` or `run` on the drive with results in `out`.
  [[nodiscard]] ProgramResult run_on_drive(const std::string& command,
                                           const Arguments& more,
                                           const std::string& out = "out") const {
    return run(Arguments{command, data.drive.string(), "--out", place(out)} + kSmallPictures +
               more);
  }

  [[nodiscard]] ProgramResult evaluate(const Arguments& more,
                                       const std::string& out = "out") const {
    return run_on_drive("evaluate", more, out);
  }

  [[nodiscard]] std::string place(const std::string& name) const {
    return (root.path() / name).string();
  }

  [[nodiscard]] std::string result(const std::string& name) const {
    return read_bytes(root.path() / "out" / name);
  }

  /// Expects a failure with one line on stderr that has these words, and no results.
  void expect_refused(const ProgramResult& result,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
    EXPECT_FALSE(fs::exists(root.path() / "out"));
  }

  /// Spoils a file of the drive and expects `evaluate` to name it.
  void expect_bad_file(const fs::path& file,
                       const std::string& text,
                       const std::string& place) const {
    SCOPED_TRACE(place);
    const std::string before = read_bytes(file);
    write_text(file, text);
    expect_refused(evaluate({"--labels", data.labels.string()}), 3, {file.string() + place});
    write_text(file, before);
  }

  SyntheticDrive world;
  TempFolder root;
  DrivePaths data;
};

// --- what is written ---

TEST_F(CommandLineSystem, EvaluateWritesItsSixFiles) {
  const ProgramResult r = evaluate({"--labels", data.labels.string()});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(
      names_in(root.path() / "out"),
      ::testing::UnorderedElementsAre(
          "metrics.csv", "table.md", "report.html", "ground_truth.ply", "map.ply", "summary.json"));
  EXPECT_THAT(r.err, Not(HasSubstr("\r"))) << "a bar is for terminals only";
  const auto csv = lines_of(result("metrics.csv"));
  ASSERT_EQ(csv.size(), 5U);
  EXPECT_EQ(csv[0],
            "frame,tp,fp,tn,fn,accuracy,precision,recall,specificity,npv,error,correlation");
  EXPECT_THAT(csv[1], ::testing::StartsWith("0,"));
  EXPECT_THAT(csv[4], ::testing::StartsWith("3,"));
  EXPECT_THAT(result("table.md"), HasSubstr("| 0099 |"));
  EXPECT_THAT(result("report.html"), HasSubstr("\"sequence\":\"0099\""));
  EXPECT_THAT(result("ground_truth.ply"), ::testing::StartsWith("ply\n"));
}

TEST_F(CommandLineSystem, TheLastLineOfStdoutIsTheSummary) {
  const ProgramResult r = evaluate({"--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto lines = lines_of(r.out);
  ASSERT_FALSE(lines.empty());
  const json summary = json::parse(lines.back(), nullptr, false);
  ASSERT_TRUE(summary.is_object()) << lines.back();
  for (const std::string key : {"frame",
                                "tp",
                                "fp",
                                "tn",
                                "fn",
                                "accuracy",
                                "precision",
                                "recall",
                                "specificity",
                                "npv",
                                "error",
                                "correlation"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  EXPECT_EQ(summary["frame"], 3);
  EXPECT_EQ(summary, json::parse(result("summary.json")));
}

/// How many cells of 0.5 m of the wall the left camera sees in any frame. The camera is at (1 + x,
/// 0.25, 0.375) of the map; f = 256; the picture is 320 x 96 about (160, 48).
int seen_wall_cells(const SyntheticDrive& world) {
  std::set<std::pair<int, int>> cells;
  for (int frame = 0; frame < world.frames; ++frame) {
    const double px_per_m = 256.0 / (world.wall_x_m - 1.0 - frame * world.step_m);
    for (int i = 0; i < 48 * 16; ++i) {
      const int column = i / 16;
      const double y_m = -5.875 + 0.25 * column;
      const double z_m = -1.875 + 0.25 * (i % 16);
      const double u_px = 160.0 + (0.25 - y_m) * px_per_m;
      const double v_px = 48.0 + (0.375 - z_m) * px_per_m;
      if (u_px >= 0.0 && u_px < 320.0 && v_px >= 0.0 && v_px < 96.0) {
        cells.emplace(static_cast<int>(std::floor(2.0 * y_m)),
                      static_cast<int>(std::floor(2.0 * z_m)));
      }
    }
  }
  return static_cast<int>(cells.size());
}

TEST_F(CommandLineSystem, TheGroundTruthIsTheWallThatTheCameraSees) {
  ASSERT_EQ(evaluate({}).exit_code, 0);
  const json summary = json::parse(result("summary.json"));
  const int expected = seen_wall_cells(world);
  EXPECT_GT(expected, 100);
  EXPECT_EQ(summary["occupied_cells"], expected);
  EXPECT_EQ(summary["tp"].get<int>() + summary["fn"].get<int>(), expected);
}

TEST_F(CommandLineSystem, TheMapFindsTheWall) {
  ASSERT_EQ(evaluate({}).exit_code, 0);
  const json summary = json::parse(result("summary.json"));
  EXPECT_GT(summary["tp"], 0);
  // Binary PLY: 15 bytes a point, x first.
  const std::string ply = result("map.ply");
  const std::string body = ply.substr(ply.find("end_header\n") + 11);
  ASSERT_GE(body.size(), 15U);
  std::size_t near_the_wall = 0;
  for (std::size_t at = 0; at + 15 <= body.size(); at += 15) {
    float x_m = 0.0F;
    std::memcpy(&x_m, body.data() + at, sizeof(x_m));
    near_the_wall += std::abs(x_m - 9.25F) <= 1.0F ? 1U : 0U;
  }
  EXPECT_GT(2 * near_the_wall, body.size() / 15);
}

TEST_F(CommandLineSystem, PointsInALabelledBoxAreNoGroundTruth) {
  // A box 20 m long, 4 m wide and 10 m high about (0, 5, 8) of camera 00: it holds the wall in all
  // frames.
  std::string labels;
  for (int frame = 0; frame < world.frames; ++frame) {
    labels += label_line(frame, "Truck", "10 4 20 0 5 8 0");
  }
  write_text(data.labels, labels);
  const ProgramResult r = evaluate({"--labels", data.labels.string()});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json summary = json::parse(result("summary.json"));
  EXPECT_EQ(summary["occupied_cells"], 0);
  EXPECT_TRUE(summary["recall"].is_null());
}

TEST_F(CommandLineSystem, TheNumberOfThreadsDoesNotChangeTheResults) {
  ASSERT_EQ(evaluate({"--threads", "1"}, "one").exit_code, 0);
  ASSERT_EQ(evaluate({"--threads", "2"}, "two").exit_code, 0);
  for (const std::string name : {"metrics.csv", "map.ply", "ground_truth.ply", "table.md"}) {
    EXPECT_TRUE(read_bytes(root.path() / "one" / name) == read_bytes(root.path() / "two" / name))
        << name;
  }
}

TEST_F(CommandLineSystem, RunWritesItsFiles) {
  const ProgramResult r = run_on_drive("run", {"--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(names_in(root.path() / "out"),
              ::testing::UnorderedElementsAre(
                  "summary.json", "map.ply", "map.ot", "map.skymap", "trajectory.tum"));
  EXPECT_THAT(result("map.ot"), ::testing::StartsWith("# Octomap OcTree file"));
  const json summary = json::parse(result("summary.json"));
  EXPECT_EQ(summary, json::parse(lines_of(r.out).back()));
  EXPECT_EQ(summary["frames"], 4);
  EXPECT_EQ(summary["dropped"], 0);
  EXPECT_GT(summary["frames_per_second"], 0.0);
  for (const std::string stage : {"match", "sphere", "map"}) {
    EXPECT_GT(summary["stages"][stage]["p50_ms"], 0.0) << stage;
    EXPECT_GE(summary["stages"][stage]["p95_ms"], summary["stages"][stage]["p50_ms"]) << stage;
  }
}

TEST_F(CommandLineSystem, RunWritesTheTrajectory) {
  ASSERT_EQ(run_on_drive("run", {}).exit_code, 0);
  std::vector<std::string> poses;
  for (const std::string& line : lines_of(result("trajectory.tum"))) {
    if (!line.starts_with("#")) {
      poses.push_back(line);
    }
  }
  ASSERT_EQ(poses.size(), 4U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto words = split_words(poses[i]);
    ASSERT_EQ(words.size(), 8U);
    // 2011-09-26 13:02:25 is 1317042145; a frame every 0.125 s, 0.5 m ahead.
    const auto frame = static_cast<double>(i);
    EXPECT_NEAR(parse_number(words[0]).value_or(0.0), 1317042145.0 + 0.125 * frame, 1e-6);
    EXPECT_NEAR(parse_number(words[1]).value_or(99.0), 0.5 * frame, 1e-5);
    EXPECT_NEAR(parse_number(words[2]).value_or(99.0), 0.0, 1e-5);
    EXPECT_NEAR(std::abs(parse_number(words[7]).value_or(99.0)), 1.0, 1e-6);
  }
}

TEST_F(CommandLineSystem, RunAndEvaluateMakeTheSameMap) {
  ASSERT_EQ(evaluate({}, "evaluated").exit_code, 0);
  ASSERT_EQ(run_on_drive("run", {"--threads", "1"}, "one").exit_code, 0);
  ASSERT_EQ(run_on_drive("run", {"--threads", "2"}, "two").exit_code, 0);
  const auto file = [&](const char* name) { return read_bytes(root.path() / name); };
  EXPECT_TRUE(file("evaluated/map.ply") == file("one/map.ply"));
  EXPECT_TRUE(file("one/map.ply") == file("two/map.ply"));
  EXPECT_TRUE(file("one/map.ot") == file("two/map.ot"));
}

TEST_F(CommandLineSystem, FramesChooseAPart) {
  ASSERT_EQ(evaluate({"--frames", "1:2"}).exit_code, 0);
  const auto csv = lines_of(result("metrics.csv"));
  ASSERT_EQ(csv.size(), 3U);
  EXPECT_THAT(csv[1], ::testing::StartsWith("1,"));
  EXPECT_THAT(csv[2], ::testing::StartsWith("2,"));
}

TEST_F(CommandLineSystem, BoundsVoxelAndSequenceAreTaken) {
  const ProgramResult r =
      evaluate({"--bounds", "0,12,-6,6.5,-2,2", "--voxel", "0.25", "--sequence", "0003"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json summary = json::parse(result("summary.json"));
  EXPECT_EQ(summary["bounds_m"], json({0.0, 12.0, -6.0, 6.5, -2.0, 2.0}));
  EXPECT_EQ(summary["cells"], 48 * 50 * 16);
  EXPECT_THAT(result("table.md"), AllOf(HasSubstr("| 0003 |"), HasSubstr("843943")));
}

TEST_F(CommandLineSystem, QuietPrintsNothing) {
  const ProgramResult quiet = evaluate({"--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_THAT(quiet.out, IsEmpty());
  EXPECT_THAT(quiet.err, IsEmpty());
  EXPECT_EQ(lines_of(evaluate({"--quiet", "--json"}).out).size(), 1U);
}

TEST_F(CommandLineSystem, TheColourPairCanBeChosen) {
  const DrivePaths colour = write_drive({.frames = 1, .colour_too = true}, root.path() / "colour");
  const auto run_with = [&](const std::string& cameras) {
    return run(Arguments{"run",
                         colour.drive.string(),
                         "--out",
                         place("out"),
                         "--set",
                         "dataset.cameras=" + cameras} +
               kSmallPictures);
  };
  EXPECT_EQ(run_with("colour").exit_code, 0);
  fs::remove_all(colour.drive / "image_02");
  const ProgramResult r = run_with("colour");
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err, HasSubstr("image_02"));
}

TEST_F(CommandLineSystem, EarlierResultsAreReplaced) {
  write_text(root.path() / "out/metrics.csv", "old");
  write_text(root.path() / "out/notes.txt", "mine");
  ASSERT_EQ(evaluate({}).exit_code, 0);
  EXPECT_THAT(result("metrics.csv"), ::testing::StartsWith("frame,"));
  EXPECT_EQ(result("notes.txt"), "mine");
}

TEST_F(CommandLineSystem, ConfigPrintsTheSettings) {
  const ProgramResult defaults = run({"config"});
  EXPECT_EQ(defaults.exit_code, 0);
  EXPECT_TRUE(defaults.out == to_yaml(Config{}));
  const auto file = root.write("c.yaml", "map:\n  voxel_m: 0.25\nsphere:\n  step_deg: 2\n");
  const ProgramResult changed =
      run({"config", "--config", file.string(), "--set", "map.voxel_m=0.125"});
  EXPECT_THAT(changed.out, AllOf(HasSubstr("voxel_m: 0.125 "), HasSubstr("step_deg: 2 ")));
  EXPECT_THAT(run({"config", "--markdown"}).out, HasSubstr("`map.voxel_m`"));
}

// --- usage ---

TEST_F(CommandLineSystem, HelpIsNoError) {
  EXPECT_THAT(
      run({"--help"}).out,
      AllOf(HasSubstr("evaluate"), HasSubstr("run"), HasSubstr("rectify"), HasSubstr("config")));
  EXPECT_EQ(run({"--help"}).exit_code, 0);
  EXPECT_EQ(run({"--version"}).exit_code, 0);
  for (const std::string command : {"evaluate", "run", "rectify", "config"}) {
    const ProgramResult r = run({command, "--help"});
    EXPECT_EQ(r.exit_code, 0);
    for (const std::string option : {"--config", "--set", "--threads", "--json", "--quiet"}) {
      EXPECT_THAT(r.out, HasSubstr(option)) << command;
    }
  }
  EXPECT_THAT(run({"evaluate", "--help"}).out,
              AllOf(HasSubstr("--labels"),
                    HasSubstr("--sequence"),
                    HasSubstr("--bounds"),
                    HasSubstr("--voxel"),
                    HasSubstr("--out"),
                    HasSubstr("metrics.csv")));
  EXPECT_THAT(run({"run", "--help"}).out, AllOf(HasSubstr("--map"), HasSubstr("--out")));
}

TEST_F(CommandLineSystem, WrongUsageIsExitCodeTwo) {
  const std::string drive = data.drive.string();
  for (const Arguments& arguments : std::vector<Arguments>{{},
                                                           {"fly"},
                                                           {"--fly"},
                                                           {"evaluate"},
                                                           {"run", drive, "--fly"},
                                                           {"run", drive, "--threads", "0"},
                                                           {"run", drive, "--threads", "two"},
                                                           {"run", drive, "--map", "flat"},
                                                           {"evaluate", drive, "--voxel", "0"},
                                                           {"evaluate", drive, "--format", "bag"},
                                                           {"evaluate", drive, "--bounds"}}) {
    const ProgramResult r = run(arguments);
    EXPECT_EQ(r.exit_code, 2) << ::testing::PrintToString(arguments);
    EXPECT_THAT(r.err, Not(IsEmpty()));
    EXPECT_THAT(r.out, IsEmpty());
  }
}

TEST_F(CommandLineSystem, MalformedBoundsAreWrongUsage) {
  for (const std::string bad : {"1,2,3",
                                "0,10,-5,5,-1,x",
                                "0,10,-5,5,-1,1,2",
                                "0,10,,5,-1,1",
                                "0 10 -5 5 -1 1",
                                "0,10,-5,5,-1,nan",
                                "0,10,-5,5,-1,inf",
                                "0,10,-5,5,-1,1,"}) {
    SCOPED_TRACE(bad);
    expect_refused(evaluate({"--bounds", bad}), 2, {"--bounds", bad});
  }
}

TEST_F(CommandLineSystem, MalformedFramesAreWrongUsage) {
  for (const std::string bad : {"x", "1:2:3", "3:1", "0:99", "4:4", "1.5:2", "0:x"}) {
    SCOPED_TRACE(bad);
    expect_refused(evaluate({"--frames", bad}), 2, {"--frames", bad});
  }
}

// --- bad input ---

TEST_F(CommandLineSystem, AMissingSourceIsNamed) {
  for (const std::string command : {"evaluate", "run"}) {
    expect_refused(run({command, place("none"), "--out", place("out")}), 3, {place("none")});
    expect_refused(
        run({command, data.day.string(), "--out", place("out")}), 3, {data.day.string()});
    expect_refused(
        run({command, data.labels.string(), "--out", place("out")}), 3, {data.labels.string()});
  }
}

TEST_F(CommandLineSystem, AMissingFileIsNamed) {
  for (const std::string name : {"image_00/data/0000000001.png",
                                 "image_01/data/0000000002.png",
                                 "oxts/data/0000000001.txt",
                                 "image_00/timestamps.txt",
                                 "../calib_velo_to_cam.txt"}) {
    const fs::path file = (data.drive / name).lexically_normal();
    const std::string before = read_bytes(file);
    fs::remove(file);
    expect_refused(evaluate({}), 3, {file.string()});
    expect_refused(run_on_drive("run", {}), 3, {file.string()});
    write_text(file, before);
  }
}

TEST_F(CommandLineSystem, ABadImageIsNamed) {
  const fs::path file = data.drive / "image_01/data/0000000002.png";
  const std::string good = read_bytes(file);
  expect_bad_file(file, good.substr(0, good.size() / 2), "");
  expect_bad_file(file, "", "");
  expect_bad_file(file, "no image", "");
  const fs::path other = root.path() / "other.png";
  write_png(other, testing::texture({310, 90}, 4));
  expect_bad_file(file, read_bytes(other), "");
}

TEST_F(CommandLineSystem, ADamagedImageIsNamedInOneLine) {
  const fs::path file = data.drive / "image_01/data/0000000002.png";
  std::string bytes = read_bytes(file);
  const std::size_t middle = bytes.size() / 2;
  bytes[middle] = static_cast<char>(bytes[middle] ^ 0x55);
  expect_bad_file(file, bytes, "");
}

TEST_F(CommandLineSystem, ABadScanIsNamed) {
  const fs::path file = data.drive / "velodyne_points/data/0000000001.bin";
  const std::string good = read_bytes(file);
  expect_bad_file(file, good.substr(0, good.size() - 7), "");
  expect_bad_file(file, "", "");
}

TEST_F(CommandLineSystem, BadLabelsAreNamed) {
  const std::string good = read_bytes(data.labels);
  const std::string car = "0 0 Car 0 0 -1.5 10.0 20.0 30.0 40.0 1.5 2 4 0 5 8 0";
  expect_bad_file(data.labels, good + label_line(4, "Car", "1 1 1 0 0 9 0"), ":5:");
  expect_bad_file(data.labels, testing::still_labels(3), ":3:");
  expect_bad_file(data.labels, car + " 1 2\n" + good, ":1:");
  expect_bad_file(data.labels, good + replaced(car, "1.5 2 4", "1.5 x 4") + "\n", ":5:");
  expect_bad_file(data.labels, good + replaced(car, "1.5 2 4", "1.5 0 4") + "\n", ":5:");
  expect_refused(evaluate({"--labels", place("none.txt")}), 3, {place("none.txt")});
}

TEST_F(CommandLineSystem, LabelsThatEndEarlyCanBeAllowed) {
  write_text(data.labels, testing::still_labels(3));
  EXPECT_EQ(
      evaluate({"--labels", data.labels.string(), "--set", "evaluation.labels_may_end_early=true"})
          .exit_code,
      0);
}

TEST_F(CommandLineSystem, ABadCalibrationIsNamed) {
  // Line 4 is P_rect_00 (after two lines of other facts and R_rect_00).
  const fs::path cameras = data.day / "calib_cam_to_cam.txt";
  const std::string good = read_bytes(cameras);
  expect_bad_file(cameras, replaced(good, "P_rect_01", "P_rect_09"), ": P_rect_01");
  expect_bad_file(cameras, replaced(good, "P_rect_00:", "P_rect_00: 1"), ":4: P_rect_00");
  expect_bad_file(cameras, replaced(good, "1.0 0.0\n", "1.0 nan\n"), ":4: P_rect_00");
  expect_bad_file(cameras, replaced(good, "R_rect_00: 1.0", "R_rect_00: 1.5"), ":3: R_rect_00");
  const fs::path body = data.day / "calib_imu_to_velo.txt";
  expect_bad_file(body, replaced(read_bytes(body), "T: -0.75 0", "T: -0.75"), ":3: T");
}

TEST_F(CommandLineSystem, ABadInsFileIsNamed) {
  const fs::path file = data.drive / "oxts/data/0000000002.txt";
  expect_bad_file(file, "0.0 8.0 116.5 0 0 0\n", ":1:");
  expect_bad_file(file, "", "");
  expect_bad_file(file, replaced(read_bytes(file), "116.5", "nan"), ":1:");
}

TEST_F(CommandLineSystem, BadTimeStampsAreNamed) {
  const fs::path file = data.drive / "image_00/timestamps.txt";
  expect_bad_file(file, read_bytes(file) + "2011-09-26 25:02:25.0\n", ":5:");
}

TEST_F(CommandLineSystem, BoundsTheWrongWayRoundAreRefused) {
  expect_refused(evaluate({"--bounds", "0,10,5,-5,-1,1"}), 3, {"y"});
  expect_refused(evaluate({"--bounds", "0,10,-5,5,1,1"}), 3, {"z"});
}

TEST_F(CommandLineSystem, ABadConfigurationIsNamed) {
  const std::string file = root.write("bad.yaml", "map:\n  voxel_m: 0.5\n  voxels: 3\n").string();
  expect_refused(evaluate({"--config", file}), 3, {file + ":3:", "map.voxels"});
  const std::string broken = root.write("broken.yaml", "map: [1\n").string();
  expect_refused(evaluate({"--config", broken}), 3, {broken + ":"});
  expect_refused(evaluate({"--config", place("none.yaml")}), 3, {place("none.yaml")});
  expect_refused(run({"config", "--config", file}), 3, {file + ":3:"});
}

TEST_F(CommandLineSystem, ABadSettingIsNamed) {
  for (const auto& [assignment, key] : std::vector<std::pair<std::string, std::string>>{
           {"map.voxels=1", "map.voxels"},
           {"maps.voxel_m=1", "maps"},
           {"sphere.step_rad=0.1", "sphere.step_rad"},
           {"map.voxel_m=small", "map.voxel_m"},
           {"map.voxel_m=-1", "map.voxel_m"},
           {"matching.max_disparity_px=20", "max_disparity_px"},
           {"opencv.paths=7", "paths"},
           {"sphere.step_deg=7", "step"},
           {"nonsense", "nonsense"}}) {
    SCOPED_TRACE(assignment);
    expect_refused(evaluate({"--set", assignment}), 3, {key});
  }
}

TEST_F(CommandLineSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  const fs::path file = root.write("file", "in the way");
  for (const std::string command : {"evaluate", "run"}) {
    for (const std::string out : {"file", "file/out"}) {
      const ProgramResult r = run_on_drive(command, {}, out);
      EXPECT_EQ(r.exit_code, 1);
      EXPECT_EQ(lines_of(r.err).size(), 1U) << r.err;
      EXPECT_THAT(r.err, HasSubstr(place(out)));
    }
  }
  EXPECT_EQ(read_bytes(file), "in the way");
}

TEST_F(CommandLineSystem, AFailureLeavesEarlierResultsAlone) {
  write_text(root.path() / "out/metrics.csv", "old");
  write_text(data.drive / "velodyne_points/data/0000000003.bin", "short");
  const ProgramResult r = evaluate({});
  EXPECT_EQ(r.exit_code, 3) << r.err;
  EXPECT_EQ(result("metrics.csv"), "old");
  EXPECT_EQ(names_in(root.path() / "out").size(), 1U);
}

TEST_F(CommandLineSystem, AMissingScanIsSkippedAloud) {
  fs::remove(data.drive / "velodyne_points/data/0000000002.bin");
  const ProgramResult r = evaluate({});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_THAT(lines_of(r.err), ::testing::Contains(AllOf(HasSubstr("scan"), HasSubstr("2"))));
  EXPECT_EQ(json::parse(result("summary.json"))["skipped_scans"], json({2}));
}

// --- interrupts ---

/// Waits until a folder is there; false after ten seconds.
bool appears(const fs::path& folder) {
  for (int i = 0; i < 10000; ++i) {
    if (fs::exists(folder)) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST_F(CommandLineSystem, AnInterruptLeavesNothingBehind) {
  // The same four pictures over and over: long enough to be caught at work.
  constexpr int kFrames = 600;
  std::string stamps;
  for (int frame = 0; frame < kFrames; ++frame) {
    for (const std::string kind :
         {"image_00/data/*.png", "image_01/data/*.png", "oxts/data/*.txt"}) {
      const std::string ending = kind.substr(kind.size() - 4);
      const fs::path folder = (data.drive / kind).parent_path();
      const fs::path to = folder / testing::synthetic_name(frame, ending);
      if (!fs::exists(to)) {
        fs::create_hard_link(folder / testing::synthetic_name(frame % 4, ending), to);
      }
    }
    stamps += "2011-09-26 13:02:25.0\n";
  }
  write_text(data.drive / "image_00/timestamps.txt", stamps);
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program(SKYHALO_PROGRAM,
                    {"run", data.drive.string(), "--out", place("out"), "--threads", "1"},
                    root.path());
    EXPECT_TRUE(appears(root.path() / "out"));
    program.send(signal);
    const ProgramResult r = program.wait();
    EXPECT_EQ(r.exit_code, 130);
    EXPECT_EQ(lines_of(r.err).size(), 1U) << r.err;
    EXPECT_FALSE(fs::exists(root.path() / "out"));
  }
}

}  // namespace
}  // namespace skyhalo
