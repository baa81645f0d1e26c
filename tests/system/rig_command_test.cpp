// `skyhalo rig`: what it prints and writes, and how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/calibration_texts.hpp"
#include "support/program.hpp"
#include "support/rig_texts.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using testing::CalibrationText;
using testing::changed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kRawRig;
using testing::kRectifiedRig;
using ::testing::Not;
using testing::ProgramResult;
using testing::TempFolder;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

json last_line(const std::string& text) {
  const auto lines = lines_of(text);
  return lines.empty() ? json() : json::parse(lines.back(), nullptr, false);
}

class RigCommandSystem : public ::testing::Test {
 protected:
  [[nodiscard]] ProgramResult run(Arguments arguments) const {
    arguments.insert(arguments.begin(), "rig");
    return testing::run_program(SKYHALO_PROGRAM, arguments, logs.path());
  }

  [[nodiscard]] std::string place(const std::string& name) const {
    return (folder.path() / name).string();
  }

  /// The files of a calibration, the first one changed, as arguments of `rig import`.
  [[nodiscard]] Arguments written(const CalibrationText& text,
                                  const std::string& from = "",
                                  const std::string& to = "") const {
    Arguments arguments{"import"};
    for (const auto& [name, content] : text.files) {
      const bool first = arguments.size() == 1;
      arguments.push_back(
          folder.write(name, first ? changed(content, from, to) : content).string());
    }
    if (text.format == "kitti-tracking") {  // its files do not say the size
      arguments.insert(arguments.end(), {"--size", "1242x375"});
    }
    return arguments;
  }

  /// Expects a failure with one line on stderr that has these words, and nothing on stdout.
  static void expect_refused(const ProgramResult& result,
                             int exit_code,
                             const std::vector<std::string>& words) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
  }

  TempFolder folder;
  TempFolder logs;
};

// --- help and usage ---

TEST_F(RigCommandSystem, HelpSaysWhatEachCommandDoes) {
  const ProgramResult rig = run({"--help"});
  EXPECT_EQ(rig.exit_code, 0);
  EXPECT_THAT(rig.out, AllOf(HasSubstr("import"), HasSubstr("check"), HasSubstr("schema")));
  const ProgramResult imported = run({"import", "--help"});
  EXPECT_EQ(imported.exit_code, 0);
  for (const std::string word : {"Kalibr",
                                 "EuRoC",
                                 "OpenCV",
                                 "ROS",
                                 "Basalt",
                                 "KITTI",
                                 "--out",
                                 "--format",
                                 "--facing",
                                 "--body",
                                 "--model",
                                 "--hfov-deg",
                                 "--size",
                                 "--name",
                                 "--json",
                                 "--quiet"}) {
    EXPECT_THAT(imported.out, HasSubstr(word));
  }
  for (const CalibrationText& text : testing::calibration_texts()) {
    EXPECT_THAT(imported.out, HasSubstr(text.format));
  }
  const ProgramResult check = run({"check", "--help"});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(check.out,
              AllOf(HasSubstr("RIG"), HasSubstr("T_body_camera"), HasSubstr("x forward")));
  EXPECT_EQ(run({"schema", "--help"}).exit_code, 0);
}

TEST_F(RigCommandSystem, WrongUsageEndsWithTwo) {
  const std::string calibration = written(testing::calibration_texts()[0])[1];
  const std::vector<Arguments> wrong = {{},
                                        {"paint"},
                                        {"import"},
                                        {"check"},
                                        {"import", calibration, "--format", "word"},
                                        {"import", calibration, "--facing", "sideways"},
                                        {"import", calibration, "--body", "wheel"},
                                        {"import", calibration, "--model", "cubic"},
                                        {"import", calibration, "--hfov-deg", "-3"},
                                        {"import", calibration, "--hfov-deg", "wide"},
                                        {"import", calibration, "--hfov-deg", "nan"},
                                        {"import", calibration, "--hfov-deg", "inf"},
                                        {"import", calibration, "--size", "12"},
                                        {"import", calibration, "--size", "12x"},
                                        {"import", calibration, "--size", "x12"},
                                        {"import", calibration, "--size", "0x12"},
                                        {"import", calibration, "--size", "-5x12"},
                                        {"import", calibration, "--size", "12x12x12"},
                                        {"import", calibration, "--paint"},
                                        {"check", calibration, calibration},
                                        {"schema", "surplus"}};
  for (const Arguments& arguments : wrong) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(arguments) << result.err;
    EXPECT_THAT(result.err, Not(IsEmpty()));
  }
}

// --- schema ---

TEST_F(RigCommandSystem, SchemaPrintsTheFileOfTheProject) {
  const ProgramResult result = run({"schema"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, read_bytes(fs::path(SKYHALO_SOURCE_DIR) / "config/rig.schema.json"));
}

// --- check ---

TEST_F(RigCommandSystem, CheckPrintsTheNumbersOfAGoodRig) {
  const ProgramResult result = run({"check", folder.write("rig.yaml", kRectifiedRig).string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("0.1000 m"), HasSubstr("640 x 480"), HasSubstr("forward")));
  EXPECT_THAT(lines_of(result.out).back(), "Nothing looks wrong.");
}

TEST_F(RigCommandSystem, TheLastLineOfCheckIsJson) {
  const std::string file = folder.write("rig.yaml", kRectifiedRig).string();
  const json summary = last_line(run({"check", file, "--json"}).out);
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["warnings"], json::array());
  ASSERT_EQ(summary["pairs"].size(), 1U);
  const json& pair = summary["pairs"][0];
  EXPECT_EQ(pair["name"], "front");
  EXPECT_EQ(pair["model"], "pinhole");
  EXPECT_EQ(pair["raw"], false);
  EXPECT_EQ(pair["baseline_m"], 0.1);
  EXPECT_EQ(pair["size_px"], json({640, 480}));
  EXPECT_EQ(pair["looks"], "forward");
  EXPECT_NEAR(pair["hfov_deg"].get<double>(), 77.3196165, 1e-6);  // 2 atan(320/400)
  EXPECT_NEAR(pair["min_range_m"].get<double>(), 0.3125, 1e-12);  // 200 px * 0.1 m / 64 px
  const ProgramResult quiet = run({"check", file, "--json", "--quiet"});
  EXPECT_EQ(lines_of(quiet.out).size(), 1U);
  EXPECT_EQ(last_line(quiet.out), summary);
  EXPECT_THAT(run({"check", file, "--quiet"}).out, IsEmpty());
}

TEST_F(RigCommandSystem, CheckWarnsWithoutRefusing) {
  const std::string file =
      folder
          .write("rig.yaml",
                 changed(
                     changed(kRawRig, "0, -0.1]", "0, -100]"), "[0, 1, 0, 0]", "[0, 1.0001, 0, 0]"))
          .string();
  const ProgramResult result = run({"check", file, "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(lines_of(result.err).size(), 3U) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr(":13: pairs[0].T_right_left: the rotation is not"),
                    HasSubstr("pair front: the baseline of 100 m looks like milli"),
                    HasSubstr("pair front: max_range_m lies below")));
  EXPECT_THAT(result.out, HasSubstr("3 warnings."));
  EXPECT_EQ(last_line(result.out)["warnings"].size(), 3U);
  EXPECT_THAT(run({"check", file, "--quiet"}).err, IsEmpty());
}

TEST_F(RigCommandSystem, CheckRefusesWrongRigs) {
  const auto refuse_all = [&](const std::string& good, const auto& changes) {
    for (const testing::WrongRig& change : changes) {
      SCOPED_TRACE(change.from + " -> " + change.to);
      const std::string file =
          folder.write("rig.yaml", changed(good, change.from, change.to)).string();
      std::vector<std::string> words = change.words;
      words.push_back("skyhalo: " + file + ":");
      expect_refused(run({"check", file, "--json"}), 3, words);
    }
  };
  refuse_all(kRawRig, testing::wrong_raw_rigs());
  refuse_all(kRectifiedRig, testing::wrong_rectified_rigs());
}

TEST_F(RigCommandSystem, CheckPrintsNumbersOfAnySize) {
  for (const auto& [from, to] : {std::pair("focal_px: 400", "focal_px: 1e300"),
                                 std::pair("baseline_m: 0.1", "baseline_m: 999.9"),
                                 std::pair("[0.1, -0.05, 0.02]", "[1000, -1000, 1e-300]")}) {
    const std::string file = folder.write("rig.yaml", changed(kRectifiedRig, from, to)).string();
    const ProgramResult result = run({"check", file, "--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(last_line(result.out).is_object());
    for (const std::string& text : {result.out, result.err}) {
      EXPECT_TRUE(std::all_of(
          text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }))
          << to << "\n"
          << text;
    }
  }
}

TEST_F(RigCommandSystem, CheckTellsWhatCannotBeRectified) {
  for (const testing::WrongRig& change : testing::wrong_raw_pairs()) {
    SCOPED_TRACE(change.from + " -> " + change.to);
    const std::string file =
        folder.write("rig.yaml", changed(kRawRig, change.from, change.to)).string();
    const ProgramResult result = run({"check", file, "--json"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("skyhalo: " + file + ":"));
    for (const std::string& word : change.words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
    EXPECT_EQ(last_line(result.out)["pairs"], json::array());
    EXPECT_EQ(last_line(result.out)["unusable"].size(), 1U);
  }
}

TEST_F(RigCommandSystem, CheckRefusesWhatIsNoRig) {
  for (const std::string& file : {folder.write("empty.yaml", "").string(),
                                  folder.write("a.png", std::string("\x89PNG\0\0\x1a", 7)).string(),
                                  place("missing.yaml"),
                                  folder.path().string()}) {
    expect_refused(run({"check", file}), 3, {"skyhalo: " + file});
  }
}

}  // namespace
}  // namespace skyhalo
