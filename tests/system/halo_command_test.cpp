// `skyhalo halo` as its users see it: the table, the pictures, the comparison with the laser, and
// how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/rig_texts.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"
#include "support/textured_pair.hpp"

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
using testing::SyntheticDrive;
using testing::TempFolder;

/// One point of a scan file.
std::string scan_record(double x_m, double y_m, double z_m) {
  const std::array<float, 4> record{
      static_cast<float>(x_m), static_cast<float>(y_m), static_cast<float>(z_m), 0.5F};
  std::array<char, sizeof(record)> raw{};
  std::memcpy(raw.data(), record.data(), raw.size());
  return {raw.data(), raw.size()};
}

/// A point given in the body frame.
std::string body_record(double x_m, double y_m, double z_m) {
  using testing::kSyntheticLaserInBody;
  return scan_record(x_m - kSyntheticLaserInBody[0],
                     y_m - kSyntheticLaserInBody[1],
                     z_m - kSyntheticLaserInBody[2]);
}

/// A road 1 m below the body, as far as the wall.
std::string road_scan(double wall_x_m) {
  std::string bytes;
  for (double x_m = 4.25; x_m < wall_x_m; x_m += 0.25) {
    for (double y_m = -2.0; y_m <= 2.0; y_m += 0.25) {
      bytes += body_record(x_m, y_m, -1.0);
    }
  }
  return bytes;
}

/// The lines of a CSV file, split at the commas.
std::vector<std::vector<std::string>> table_of(const fs::path& file) {
  std::vector<std::vector<std::string>> table;
  for (const std::string& line : read_lines(file)) {
    std::vector<std::string>& words = table.emplace_back(1);
    for (const char c : line) {
      if (c == ',') {
        words.emplace_back();
      } else {
        words.back() += c;
      }
    }
  }
  return table;
}

/// The numbers below a column's name; -1 for an empty field.
std::vector<double> column(const std::vector<std::vector<std::string>>& table,
                           const std::string& name) {
  const auto at = std::find(table.front().begin(), table.front().end(), name);
  EXPECT_NE(at, table.front().end()) << name;
  std::vector<double> values;
  for (std::size_t row = 1; row < table.size() && at != table.front().end(); ++row) {
    const auto col = static_cast<std::size_t>(at - table.front().begin());
    values.push_back(parse_number(table[row].at(col)).value_or(-1.0));
  }
  return values;
}

/// The wall is 9.25 m ahead of the body at first and comes half a metre nearer in each of 4 frames.
class HaloCommandSystem : public ::testing::Test {
 protected:
  void SetUp() override {
    drive = testing::write_drive(world, folder.path()).drive;
    for (int frame = 0; frame < world.frames; ++frame) {
      append_to_scan(frame, road_scan(wall_m(frame)));
    }
  }

  [[nodiscard]] double wall_m(int frame) const { return world.wall_x_m - frame * world.step_m; }

  [[nodiscard]] fs::path scan_file(int frame) const {
    return drive / "velodyne_points/data" / testing::synthetic_name(frame, ".bin");
  }

  void append_to_scan(int frame, const std::string& bytes) const {
    std::ofstream(scan_file(frame), std::ios::binary | std::ios::app) << bytes;
  }

  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, Arguments{"halo"} + arguments, logs.path());
  }

  /// The drive as stored, with more options.
  [[nodiscard]] ProgramResult look(const Arguments& more = {}) const {
    return run(Arguments{drive.string(), "-o", out} + more);
  }

  /// The summary of a run that ends well.
  [[nodiscard]] json summary(const Arguments& more = {}) const {
    const ProgramResult result = look(more + Arguments{"--json", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out, nullptr, false);
  }

  [[nodiscard]] std::vector<std::vector<std::string>> table() const {
    return table_of(fs::path(out) / "halo.csv");
  }

  void expect_refused(const ProgramResult& result,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
    EXPECT_FALSE(fs::exists(out));
  }

  SyntheticDrive world{.image_size_px = {320, 192}, .principal_v_px = 96.0};  // sees the road
  TempFolder folder;
  TempFolder logs;
  fs::path drive;
  std::string out = (folder.path() / "out").string();
};

// --- the files ---

TEST_F(HaloCommandSystem, TheTableHasALineForEachFrame) {
  const json result = summary();
  EXPECT_EQ(result["frames"], 4);
  EXPECT_EQ(result["dropped"], 0);
  EXPECT_EQ(result["step_deg"], 1.0);
  EXPECT_EQ(result["cone_deg"], 20.0);
  EXPECT_EQ(result["source"], drive.filename().string());
  EXPECT_TRUE(result["stages"].contains("match"));
  EXPECT_TRUE(result["stages"].contains("stitch"));
  EXPECT_FALSE(result["stages"].contains("map")) << "there is none";
  EXPECT_FALSE(result.contains("agreement"));
  EXPECT_EQ(json::parse(read_bytes(fs::path(out) / "summary.json")), result);
  const auto lines = table();
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines.front(),
            (Arguments{"frame",
                       "stamp_s",
                       "obstacle_cells",
                       "free_cells",
                       "unseen_cells",
                       "forward_nearest_m",
                       "nearest_m",
                       "azimuth_deg",
                       "pitch_deg",
                       "forward_limit_mps",
                       "reason"}));
  for (const auto& line : lines) {
    EXPECT_EQ(line.size(), lines.front().size());
  }
}

TEST_F(HaloCommandSystem, TheTableSaysHowFarTheWallIs) {
  (void)summary();
  const auto lines = table();
  EXPECT_EQ(column(lines, "frame"), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(lines[2][1], "1317042145.125000000");  // 2011-09-26 13:02:25.125, from `date`
  for (std::size_t i = 0; i < 4; ++i) {
    const double cells = column(lines, "obstacle_cells")[i] + column(lines, "free_cells")[i] +
                         column(lines, "unseen_cells")[i];
    EXPECT_EQ(cells, 180.0 * 360.0);
    EXPECT_GT(column(lines, "obstacle_cells")[i], 100.0);
    EXPECT_NEAR(column(lines, "forward_nearest_m")[i], wall_m(static_cast<int>(i)), 0.5);
    EXPECT_LE(column(lines, "nearest_m")[i], column(lines, "forward_nearest_m")[i]);
    EXPECT_LT(std::abs(column(lines, "azimuth_deg")[i]), 40.0);
    EXPECT_LT(std::abs(column(lines, "pitch_deg")[i]), 30.0);
    EXPECT_LT(column(lines, "forward_limit_mps")[i], 20.0);
    EXPECT_THAT(lines[i + 1][10], ::testing::AnyOf("obstacle", "unseen"));
  }
}

TEST_F(HaloCommandSystem, TheLimitGoesByTheSafetySettings) {
  const Arguments careless{"--set",
                           "safety.unseen=allow",
                           "--set",
                           "safety.brake_mps2=1000",
                           "--set",
                           "safety.brake_vertical_mps2=1000",
                           "--set",
                           "safety.delay_s=0"};
  (void)summary(careless);
  for (const double limit_mps : column(table(), "forward_limit_mps")) {
    EXPECT_NEAR(limit_mps, 20.0, 1e-3);
  }
  EXPECT_EQ(table()[1][10], "none");
  (void)summary({"--set", "safety.unseen=allow", "--set", "safety.avoidance=stop"});
  const auto limits = column(table(), "forward_limit_mps");
  // sqrt(2 * 3 * 9.25) = 7.4 m/s would be the braking distance alone.
  EXPECT_GT(limits.front(), 0.5);
  EXPECT_LT(limits.front(), 7.4);
  EXPECT_TRUE(std::is_sorted(limits.rbegin(), limits.rend())) << "nearer is slower";
  EXPECT_EQ(table()[1][10], "obstacle");
}

TEST_F(HaloCommandSystem, AWiderConeSeesNoLess) {
  (void)summary({"--cone-deg", "2"});
  const auto narrow = column(table(), "forward_nearest_m");
  (void)summary({"--cone-deg", "180"});
  const auto wide = column(table(), "forward_nearest_m");
  EXPECT_EQ(wide, column(table(), "nearest_m"));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GE(narrow[i], wide[i]);
  }
}

TEST_F(HaloCommandSystem, OnlyTheFramesAskedForAreUsed) {
  EXPECT_EQ(summary({"--frames", "1:2"})["frames"], 2);
  EXPECT_EQ(column(table(), "frame"), (std::vector<double>{1, 2}));
}

TEST_F(HaloCommandSystem, PicturesAreMadeOfTheFramesAskedFor) {
  json result = summary({"--picture-frames", "3,1"});
  EXPECT_EQ(result["pictures"], json({"frame_000001.png", "frame_000003.png"}));
  EXPECT_FALSE(fs::exists(fs::path(out) / "frame_000000.png"));
  const cv::Mat picture = read_image(fs::path(out) / "frame_000003.png");
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_GT(picture.cols, 2000);
  EXPECT_GT(picture.rows, 1000);
  fs::remove_all(out);
  result = summary({"--picture-every", "2", "--frames", "1:3"});
  EXPECT_EQ(result["pictures"], json({"frame_000001.png", "frame_000003.png"}));
  fs::remove_all(out);
  EXPECT_EQ(summary()["pictures"], json::array());
}

TEST_F(HaloCommandSystem, PicturesOfAnEarlierRunDoNotStandAmongTheNew) {
  (void)summary({"--picture-frames", "1"});
  EXPECT_EQ(summary({"--picture-frames", "1,2"})["pictures"].size(), 2U);
  const ProgramResult result = look({"--picture-frames", "2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("frame_000001.png"), HasSubstr("earlier run")));
}

TEST_F(HaloCommandSystem, TheNumberOfThreadsDoesNotChangeTheResult) {
  const Arguments more{"--picture-frames", "2", "--laser"};
  (void)summary(more + Arguments{"--threads", "1"});
  const std::string one = read_bytes(fs::path(out) / "halo.csv");
  const std::string one_picture = read_bytes(fs::path(out) / "frame_000002.png");
  (void)summary(more + Arguments{"--threads", "2"});
  EXPECT_EQ(read_bytes(fs::path(out) / "halo.csv"), one);
  EXPECT_EQ(read_bytes(fs::path(out) / "frame_000002.png"), one_picture);
}

TEST_F(HaloCommandSystem, ThereIsATextForPeople) {
  const ProgramResult result = look({"--laser", "--picture-frames", "0"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("4 frames, 0 dropped"),
                    HasSubstr("agree"),
                    HasSubstr("4 of 4 frames"),
                    HasSubstr("halo.csv"),
                    HasSubstr(out)));
  EXPECT_THAT(result.err, IsEmpty());
  const ProgramResult quiet = look({"--picture-frames", "0", "--quiet"});
  EXPECT_THAT(quiet.out + quiet.err, IsEmpty());
}

TEST_F(HaloCommandSystem, HelpExplainsTheOptionsAndTheTable) {
  const ProgramResult result = run({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string word : {"SOURCE",
                                 "--rig",
                                 "--frames",
                                 "--picture-frames",
                                 "--cone-deg",
                                 "--picture-every",
                                 "--laser",
                                 "--out",
                                 "--json",
                                 "halo.csv",
                                 "forward_nearest_m",
                                 "forward_limit_mps",
                                 "free_cells",
                                 "laser_nearest_m",
                                 "frame_NNNNNN.png",
                                 "summary.json"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

// --- against the laser ---

TEST_F(HaloCommandSystem, LaserAndHaloAgreeOnTheWall) {
  const json result = summary({"--laser"});
  EXPECT_EQ(result["frames_compared"], 4);
  EXPECT_EQ(result["agreeing"], 4);
  EXPECT_EQ(result["agreement"], 1.0);
  EXPECT_EQ(result["disagreeing"], json::array());
  EXPECT_THAT(result["bound"].get<std::string>(), AllOf(HasSubstr("0.5 m"), HasSubstr("10 %")));
  EXPECT_EQ(result["supported"]["agreement"], 1.0);
  const auto lines = table();
  EXPECT_EQ(column(lines, "agrees"), (std::vector<double>{1, 1, 1, 1}));
  for (std::size_t i = 0; i < 4; ++i) {
    const double wall = wall_m(static_cast<int>(i));
    // The point of the wall nearest to the body's x axis is 0.125 m aside and above.
    EXPECT_NEAR(column(lines, "laser_nearest_m")[i], std::hypot(wall, 0.125, 0.125), 1e-3);
    EXPECT_NEAR(column(lines, "stereo_nearest_m")[i], wall, 0.5);
  }
}

TEST_F(HaloCommandSystem, TheRoadIsNoThing) {
  // Lower than 0.2 m above the road: no thing; higher: one that the images do not show.
  append_to_scan(0, body_record(6.0, 0.0, -0.85));
  append_to_scan(1, body_record(6.0, 0.0, -0.75));
  const json result = summary({"--laser"});
  EXPECT_EQ(column(table(), "agrees"), (std::vector<double>{1, 0, 1, 1}));
  EXPECT_EQ(result["agreement"], 0.75);
  ASSERT_EQ(result["disagreeing"].size(), 1U);
  EXPECT_EQ(result["disagreeing"][0]["frame"], 1);
  EXPECT_NEAR(result["disagreeing"][0]["laser_m"].get<double>(), std::hypot(6.0, 0.75), 1e-3);
  EXPECT_NEAR(result["disagreeing"][0]["stereo_m"].get<double>(), wall_m(1), 0.5);
  // A single point is borne out by nothing.
  EXPECT_EQ(result["supported"]["agreement"], 1.0);
  EXPECT_EQ(column(table(), "supported_agrees"), (std::vector<double>{1, 1, 1, 1}));
}

TEST_F(HaloCommandSystem, ThreePointsBearAThingOut) {
  append_to_scan(2, body_record(6.0, 0.0, 0.0) + body_record(6.0, 0.25, 0.0));
  append_to_scan(3, body_record(6.0, 0.0, 0.0) + body_record(6.0, 0.25, 0.0));
  append_to_scan(3, body_record(6.0, 0.0, 0.25));
  const json result = summary({"--laser"});
  EXPECT_EQ(column(table(), "agrees"), (std::vector<double>{1, 1, 0, 0}));
  EXPECT_EQ(column(table(), "supported_agrees"), (std::vector<double>{1, 1, 1, 0}));
  EXPECT_NEAR(column(table(), "laser_supported_m")[3], 6.0, 1e-3);
  EXPECT_EQ(result["supported"]["agreeing"], 3);
}

TEST_F(HaloCommandSystem, WhatIsOutsideTheConeIsNotCompared) {
  append_to_scan(0, body_record(6.0, 1.0, 0.0));  // 9.5 degrees aside
  EXPECT_EQ(summary({"--laser", "--cone-deg", "9"})["agreeing"], 4);
  EXPECT_EQ(summary({"--laser", "--cone-deg", "10"})["agreeing"], 3);
}

TEST_F(HaloCommandSystem, FramesWithoutScanOrRoadAreNamedAndNotCompared) {
  fs::remove(scan_file(1));
  std::ofstream(scan_file(2), std::ios::binary | std::ios::trunc)
      << testing::wall_scan(world, 2 * world.step_m);
  const ProgramResult result = look({"--laser", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("scans missing, not compared: frame 1"),
                    HasSubstr("no road in the laser scan, not compared: frame 2")));
  const json found = json::parse(read_bytes(fs::path(out) / "summary.json"));
  EXPECT_EQ(found["frames"], 4);
  EXPECT_EQ(found["frames_compared"], 2);
  EXPECT_EQ(found["without_scan"], json({1}));
  EXPECT_EQ(found["without_road"], json({2}));
  EXPECT_EQ(column(table(), "agrees"), (std::vector<double>{1, -1, -1, 1}));
  for (const auto& line : table()) {
    EXPECT_EQ(line.size(), 16U);
  }
}

TEST_F(HaloCommandSystem, WithoutAnyScanThereIsNothingToCompare) {
  fs::remove_all(drive / "velodyne_points");
  expect_refused(look({"--laser"}), 3, {drive.string(), "laser scan"});
  EXPECT_EQ(look().exit_code, 0);
}

TEST_F(HaloCommandSystem, AScanThatIsCutOffIsNamed) {
  fs::resize_file(scan_file(2), 100);
  expect_refused(look({"--laser"}), 3, {scan_file(2).string()});
}

// --- other recordings ---

/// A EuRoC flight of one frame without ground truth, and a rig of rectified cameras that fits it.
class FlightHaloCommandSystem : public HaloCommandSystem {
 protected:
  void SetUp() override {
    const testing::TexturedPair pair = testing::textured_pair({640, 480}, 20, 3);
    for (const int camera : {0, 1}) {
      const std::string name = "flight/mav0/cam" + std::to_string(camera);
      (void)folder.write(name + "/data.csv",
                         "#timestamp [ns],filename\n1000000000000000000,1000000000000000000.png\n");
      fs::create_directories(folder.path() / name / "data");
      write_png(folder.path() / name / "data/1000000000000000000.png",
                camera == 0 ? pair.left : pair.right);
    }
    drive = folder.path() / "flight";
    rig = folder.write("rig.yaml", testing::kRectifiedRig).string();
  }

  std::string rig;
};

TEST_F(FlightHaloCommandSystem, AFlightWithoutPosesHasAHalo) {
  EXPECT_EQ(summary({"--rig", rig, "--picture-frames", "0"})["frames"], 1);
  EXPECT_EQ(table()[1][1], "1000000000.000000000");
  // 400 px of focal length, 0.1 m, 20 px: a wall at 2 m, 0.1 m ahead of which the body ends.
  EXPECT_NEAR(column(table(), "forward_nearest_m")[0], 2.1, 0.1);
  EXPECT_TRUE(fs::exists(fs::path(out) / "frame_000000.png"));
}

TEST_F(FlightHaloCommandSystem, AFlightHasNoLaser) {
  expect_refused(look({"--rig", rig, "--laser"}), 3, {drive.string(), "laser", "KITTI"});
}

// --- how it ends when something is wrong ---

TEST_F(HaloCommandSystem, WrongUsageEndsWithTwo) {
  EXPECT_EQ(run({}).exit_code, 2);
  for (const Arguments& wrong :
       std::vector<Arguments>{{"--cone-deg", "0"},
                              {"--cone-deg", "-20"},
                              {"--cone-deg", "181"},
                              {"--cone-deg", "nan"},
                              {"--cone-deg", "wide"},
                              {"--frames", "4:4"},
                              {"--frames", "2:1"},
                              {"--frames", "many"},
                              {"--picture-frames", "4"},
                              {"--picture-frames", "1,x"},
                              {"--picture-frames", "-1"},
                              {"--picture-frames", "1,,2"},
                              {"--picture-every", "0"},
                              {"--picture-every", "2", "--picture-frames", "1"},
                              {"--threads", "0"},
                              {"--laser", "--paint"}}) {
    SCOPED_TRACE(::testing::PrintToString(wrong));
    expect_refused(look(wrong), 2, {wrong.back() == "--paint" ? "--paint" : wrong[0]});
  }
  expect_refused(look({"--frames", "0:1", "--picture-frames", "2"}), 2, {"0:1"});
}

TEST_F(HaloCommandSystem, BadInputEndsWithThree) {
  const std::string missing = (folder.path() / "none").string();
  expect_refused(run({missing, "-o", out}), 3, {missing, "no such folder"});
  expect_refused(run({folder.path().string(), "-o", out}), 3, {"no recording that is known"});
  expect_refused(look({"--set", "sphere.rule=best"}), 3, {"sphere.rule"});
  expect_refused(look({"--set", "sphere.step_deg=0.7"}), 3, {"step"});
  expect_refused(look({"--rig", missing}), 3, {missing});
  const fs::path image = drive / "image_01/data" / testing::synthetic_name(2, ".png");
  fs::resize_file(image, 100);
  expect_refused(look(), 3, {image.string()});
}

TEST_F(HaloCommandSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  const fs::path file = folder.write("file", "");
  const ProgramResult result = run({drive.string(), "-o", file.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(file.string()));
}

TEST_F(HaloCommandSystem, AFailureLeavesEarlierResultsAlone) {
  (void)summary();
  const std::string before = read_bytes(fs::path(out) / "halo.csv");
  fs::resize_file(scan_file(3), 100);
  EXPECT_EQ(look({"--laser"}).exit_code, 3);
  EXPECT_EQ(read_bytes(fs::path(out) / "halo.csv"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 2);
}

}  // namespace
}  // namespace skyhalo
