// `skyhalo rectify` on made-up images: what it writes, and how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "skyhalo/calibration/rig_file.hpp"
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
using testing::Arguments;
using testing::changed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kRawRig;
using testing::kRectifiedRig;
using testing::ProgramResult;
using testing::TempFolder;

/// Two equal cameras without distortion, side by side: what is to be seen stays as it is.
const std::string kLevelRig =
    "rig: level\n"
    "pairs:\n"
    "  - name: front\n"
    "    left: {size_px: [640, 480], lens: pinhole, intrinsics_px: [400, 400, 319.5, 239.5]}\n"
    "    right: {size_px: [640, 480], lens: pinhole, intrinsics_px: [400, 400, 319.5, 239.5]}\n"
    "    T_right_left: {position_m: [-0.1, 0, 0]}\n"
    "    rectify_to: {model: pinhole, hfov_deg: 70, size_px: [640, 480]}\n"
    "    T_body_camera: {position_m: [0, 0, 0]}\n";

json last_line(const std::string& text) {
  const std::size_t at = text.find_last_of('\n', text.size() < 2 ? 0 : text.size() - 2);
  return json::parse(text.substr(at == std::string::npos ? 0 : at + 1), nullptr, false);
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

class RectifyCommandSystem : public ::testing::Test {
 protected:
  void SetUp() override {
    const testing::TexturedPair pair = testing::textured_pair({640, 480}, 12, 7);
    left = (folder.path() / "left.png").string();
    right = (folder.path() / "right.png").string();
    write_png(left, pair.left);
    write_png(right, pair.right);
  }

  [[nodiscard]] ProgramResult run(Arguments arguments) const {
    arguments.insert(arguments.begin(), "rectify");
    arguments.insert(arguments.end(), {"-o", out().string()});
    return testing::run_program(SKYHALO_PROGRAM, arguments, logs.path());
  }

  [[nodiscard]] std::string rig(const std::string& text) const {
    return folder.write("rig.yaml", text).string();
  }

  [[nodiscard]] ProgramResult rectify(const std::string& text, const Arguments& more = {}) const {
    Arguments arguments{left, right, "--rig", rig(text)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  void expect_refused(const ProgramResult& result,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
    EXPECT_FALSE(fs::exists(out()));
    fs::remove_all(out());
  }

  [[nodiscard]] fs::path out() const { return folder.path() / "out"; }

  TempFolder folder;
  TempFolder logs;
  std::string left;
  std::string right;
};

TEST_F(RectifyCommandSystem, TwoImagesGiveAFolderOfResults) {
  const ProgramResult result = rectify(kLevelRig, {"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::set<std::string> names = names_in(out());
  for (const std::string name : {"left_000000.png",
                                 "right_000000.png",
                                 "side_by_side.png",
                                 "rows.csv",
                                 "rig.yaml",
                                 "summary.json"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  EXPECT_EQ(read_image(out() / "left_000000.png").size(), cv::Size(640, 480));
  EXPECT_EQ(read_image(out() / "right_000000.png").size(), cv::Size(640, 480));
  EXPECT_EQ(read_image(out() / "side_by_side.png").size(), cv::Size(1280, 480));
  const json summary = last_line(result.out);
  EXPECT_EQ(summary, json::parse(read_bytes(out() / "summary.json")));
  EXPECT_EQ(summary["pair"], "front");
  EXPECT_EQ(summary["frames"], 1);
  EXPECT_EQ(summary["size_px"], json({640, 480}));
  EXPECT_NEAR(summary["baseline_m"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(summary["out"], out().string());
  EXPECT_GT(summary["rows"]["matches"].get<int>(), 100);
  EXPECT_LT(summary["rows"]["median_abs_dv_px"].get<double>(), 0.1);
  EXPECT_EQ(summary["rows"]["negative_disparity_share"].get<double>(), 0.0);
  EXPECT_EQ(read_lines(out() / "rows.csv").size(), 2U);
}

TEST_F(RectifyCommandSystem, TheRigOfTheResultFitsTheImages) {
  ASSERT_EQ(rectify(kLevelRig, {"--downscale", "2"}).exit_code, 0);
  const StereoPair pair = load_rig(out() / "rig.yaml").pairs.at(0);
  EXPECT_FALSE(pair.raw.has_value());
  EXPECT_EQ(pair.image_size_px, cv::Size(320, 240));
  EXPECT_EQ(read_image(out() / "right_000000.png").size(), cv::Size(320, 240));
  EXPECT_EQ(read_image(out() / "side_by_side.png").size(), cv::Size(640, 240));
  // 640 columns over 70 degrees, shrunk by 2.
  EXPECT_NEAR(std::get<PinholePair>(pair.model).focal_px, 160.0 / 0.7002075382097097, 1e-9);
}

TEST_F(RectifyCommandSystem, WithoutTheRowCheckThereAreNoRows) {
  const ProgramResult result = rectify(kLevelRig, {"--skip-row-check", "--json"});
  ASSERT_EQ(result.exit_code, 0);
  EXPECT_FALSE(last_line(result.out).contains("rows"));
  EXPECT_FALSE(names_in(out()).contains("rows.csv"));
}

TEST_F(RectifyCommandSystem, ImagesWithoutFeaturesAreNoFailure) {
  write_png(left, cv::Mat1b(480, 640, uchar{90}));
  write_png(right, cv::Mat1b(480, 640, uchar{90}));
  const ProgramResult result = rectify(kLevelRig, {"--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json rows = last_line(result.out)["rows"];
  EXPECT_EQ(rows["matches"], 0);
  EXPECT_TRUE(rows["median_abs_dv_px"].is_null());
}

TEST_F(RectifyCommandSystem, QuietPrintsNothing) {
  const ProgramResult result = rectify(kLevelRig, {"--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out + result.err, IsEmpty());
}

TEST_F(RectifyCommandSystem, ARecordingKeepsItsOwnCameras) {
  const testing::SyntheticDrive world;
  const testing::DrivePaths data = testing::write_drive(world, folder.path() / "data");
  const ProgramResult result = run({data.drive.string(), "--frames", "1:2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(last_line(result.out)["frames"], 2);
  EXPECT_TRUE(fs::exists(out() / "left_000002.png"));
  EXPECT_EQ(read_lines(out() / "rows.csv").size(), 3U);
  EXPECT_NEAR(last_line(result.out)["baseline_m"].get<double>(), 0.5, 1e-9);
}

TEST_F(RectifyCommandSystem, HelpNamesOptionsAndResults) {
  const ProgramResult result = run({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string word : {"INPUT",
                                 "--rig",
                                 "--pair",
                                 "--frames",
                                 "--downscale",
                                 "--out",
                                 "side_by_side.png",
                                 "rows.csv",
                                 "rig.yaml",
                                 "--json"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(RectifyCommandSystem, WrongUsageEndsWithTwo) {
  expect_refused(run({left, right}), 2, {"--rig"});
  expect_refused(rectify(kLevelRig, {"--pair", "rear"}), 2, {"--pair rear", "front"});
  expect_refused(rectify(kLevelRig, {"--frames", "5:6"}), 2, {"frames"});
  expect_refused(rectify(kLevelRig, {"--frames", "x"}), 2, {"frames"});
  const std::string pair = kLevelRig.substr(kLevelRig.find("  - name"));
  const std::string two = kLevelRig + changed(pair, "front", "rear");
  expect_refused(rectify(two), 2, {"--pair", "front", "rear"});
  EXPECT_EQ(rectify(two, {"--pair", "rear", "--skip-row-check"}).exit_code, 0);
  for (const Arguments& wrong : std::vector<Arguments>{{},
                                                       {left, right, right},
                                                       {left, right, "--downscale", "0"},
                                                       {left, right, "--downscale", "two"},
                                                       {left, "--format", "word"},
                                                       {left, right, "--paint"}}) {
    EXPECT_EQ(run(wrong).exit_code, 2) << ::testing::PrintToString(wrong);
  }
}

TEST_F(RectifyCommandSystem, WrongRigsAreRefused) {
  const auto refuse_all = [&](const std::string& good, const auto& changes) {
    for (const testing::WrongRig& change : changes) {
      SCOPED_TRACE(change.from + " -> " + change.to);
      std::vector<std::string> words = change.words;
      words.push_back("skyhalo: " + (folder.path() / "rig.yaml").string() + ":");
      expect_refused(rectify(changed(good, change.from, change.to), {"--json"}), 3, words);
    }
  };
  refuse_all(kRawRig, testing::wrong_raw_rigs());
  refuse_all(kRawRig, testing::wrong_raw_pairs());
  refuse_all(kRectifiedRig, testing::wrong_rectified_rigs());
  expect_refused(rectify(""), 3, {"rig.yaml: is empty"});
  expect_refused(run({left, right, "--rig", "missing.yaml"}), 3, {"missing.yaml", "no such file"});
}

TEST_F(RectifyCommandSystem, WrongImagesAreRefused) {
  const std::string good = rig(kLevelRig);
  const auto refuse = [&](const std::string& file, const std::string& word) {
    expect_refused(run({left, file, "--rig", good}), 3, {file, word});
    expect_refused(run({file, right, "--rig", good}), 3, {file, word});
  };
  refuse(folder.write("empty.png", "").string(), "");
  refuse(folder.write("text.png", "no image").string(), "");
  refuse((folder.path() / "missing.png").string(), "no such file");
  const std::string small = (folder.path() / "small.png").string();
  write_png(small, cv::Mat1b(240, 320, uchar{90}));
  refuse(small, "320");
  expect_refused(run({folder.path().string(), "--rig", good}), 3, {folder.path().string()});
}

TEST_F(RectifyCommandSystem, AFailureLeavesEarlierResultsAlone) {
  (void)folder.write("out/left_000000.png", "old");
  EXPECT_EQ(rectify(changed(kLevelRig, "-0.1", "0.1")).exit_code, 3);
  EXPECT_EQ(read_bytes(out() / "left_000000.png"), "old");
  EXPECT_EQ(names_in(out()).size(), 1U);
}

TEST_F(RectifyCommandSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  (void)folder.write("out", "in the way");
  const ProgramResult result = rectify(kLevelRig);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(out().string()));
  EXPECT_EQ(read_bytes(out()), "in the way");
}

}  // namespace
}  // namespace skyhalo
