// `skyhalo rig import`: what it prints and writes; on wrong calibrations the exit code, one line
// with file and key, and nothing left behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/calibration_texts.hpp"
#include "support/program.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Arguments;
using testing::CalibrationText;
using testing::changed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ProgramResult;
using testing::TempFolder;

/// The last line, which is JSON with `--json`.
json last_line(const std::string& text) {
  const std::size_t at = text.find_last_of('\n', text.size() < 2 ? 0 : text.size() - 2);
  return json::parse(text.substr(at == std::string::npos ? 0 : at + 1), nullptr, false);
}

/// The text of OpenCV's YAML up to the first of these words.
std::string opencv_text_up_to(const std::string& word) {
  const std::string text = testing::opencv_text();
  return text.substr(0, text.find(word));
}

class RigImportSystem : public ::testing::Test {
 protected:
  [[nodiscard]] ProgramResult rig_command(Arguments arguments) const {
    arguments.insert(arguments.begin(), "rig");
    return testing::run_program(SKYHALO_PROGRAM, arguments, logs.path());
  }

  [[nodiscard]] ProgramResult run(Arguments arguments) const {
    arguments.insert(arguments.begin(), "import");
    return rig_command(arguments);
  }

  /// The files of a calibration, the first one with this content.
  [[nodiscard]] Arguments written(const CalibrationText& text, const std::string& first) const {
    Arguments arguments;
    for (const auto& [name, content] : text.files) {
      arguments.push_back(folder.write(name, arguments.empty() ? first : content).string());
    }
    if (text.format == "kitti-tracking") {  // its files do not say the size
      arguments.insert(arguments.end(), {"--size", "1242x375"});
    }
    return arguments;
  }

  /// Expects exit code 3, one line that names the first file and has these words, and an output
  /// that is as before, whether there was one or not.
  void expect_refused(Arguments arguments, const std::vector<std::string>& words) const {
    const TempFolder results;
    const fs::path out = results.path() / "rig.yaml";
    const std::string file = arguments.front();
    arguments.insert(arguments.end(), {"-o", out.string(), "--json"});
    for (const bool exists : {false, true}) {
      if (exists) {
        (void)results.write("rig.yaml", "old");
      }
      const ProgramResult result = run(arguments);
      EXPECT_EQ(result.exit_code, 3) << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_THAT(result.err, HasSubstr(file));
      EXPECT_THAT(result.out, IsEmpty());
      for (const std::string& word : words) {
        EXPECT_THAT(result.err, HasSubstr(word));
      }
      const auto left = std::distance(fs::directory_iterator(results.path()), {});
      EXPECT_EQ(left, exists ? 1 : 0);
      if (exists) {
        EXPECT_EQ(read_bytes(out), "old");
      }
    }
  }

  TempFolder folder;
  TempFolder logs;
};

TEST_F(RigImportSystem, ImportPrintsARigThatCheckTakes) {
  for (const CalibrationText& text : testing::calibration_texts()) {
    SCOPED_TRACE(text.format);
    const ProgramResult result = run(written(text, text.files[0].second));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("pairs:"));
    const auto rig = folder.write("printed.yaml", result.out);
    EXPECT_EQ(load_rig(rig).pairs.size(), 1U);
    EXPECT_EQ(rig_command({"check", rig.string()}).exit_code, 0);
  }
}

TEST_F(RigImportSystem, ImportWritesWhatItPrints) {
  const std::string rig = (folder.path() / "rig.yaml").string();
  for (const CalibrationText& text : testing::calibration_texts()) {
    SCOPED_TRACE(text.format);
    Arguments arguments = written(text, text.files[0].second);
    const std::string printed = run(arguments).out;
    arguments.insert(arguments.end(), {"-o", rig, "--json"});
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_bytes(rig), printed);
    const json summary = last_line(result.out);
    EXPECT_EQ(summary["format"], text.format);
    EXPECT_EQ(summary["out"], rig);
    EXPECT_EQ(summary["pairs"].size(), 1U);
    EXPECT_TRUE(summary["warnings"].is_array());
    arguments.insert(arguments.end(), {"--quiet"});
    EXPECT_EQ(last_line(run(arguments).out), summary);
    arguments.erase(std::find(arguments.begin(), arguments.end(), "--json"));
    EXPECT_THAT(run(arguments).out, IsEmpty());
  }
}

TEST_F(RigImportSystem, ImportTakesItsOptions) {
  const std::string rig = (folder.path() / "rig.yaml").string();
  const CalibrationText text = testing::calibration_texts()[0];
  Arguments arguments = written(text, text.files[0].second);
  arguments.insert(arguments.end(),
                   {"--name",
                    "my rig",
                    "--facing",
                    "left",
                    "--model",
                    "spherical",
                    "--hfov-deg",
                    "60",
                    "-o",
                    rig,
                    "--json"});
  const ProgramResult result = run(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json pair = last_line(result.out)["pairs"][0];
  EXPECT_EQ(pair["looks"], "left");
  EXPECT_EQ(pair["model"], "spherical");
  EXPECT_NEAR(pair["hfov_deg"].get<double>(), 60.0, 1e-9);
  EXPECT_EQ(read_rig_file(rig).description.name, "my rig");
}

TEST_F(RigImportSystem, WrongFilesAreRefused) {
  for (const CalibrationText& text : testing::calibration_texts()) {
    for (const testing::WrongRig& change : text.wrong) {
      SCOPED_TRACE(text.format + ": " + change.from + " -> " + change.to);
      expect_refused(written(text, changed(text.files[0].second, change.from, change.to)),
                     change.words);
    }
  }
}

TEST_F(RigImportSystem, WrongFilesAreRefusedWithTheFormatGivenToo) {
  for (const CalibrationText& text : testing::calibration_texts()) {
    const testing::WrongRig& change = text.wrong[0];
    SCOPED_TRACE(text.format);
    Arguments arguments = written(text, changed(text.files[0].second, change.from, change.to));
    arguments.insert(arguments.end(), {"--format", text.format});
    expect_refused(arguments, change.words);
  }
}

TEST_F(RigImportSystem, FilesWithoutACalibrationAreRefused) {
  for (const CalibrationText& text : testing::calibration_texts()) {
    for (const bool forced : {false, true}) {
      SCOPED_TRACE(text.format + (forced ? ", forced" : ""));
      const Arguments more = forced ? Arguments{"--format", text.format} : Arguments{};
      const auto with = [&](const std::string& first) {
        Arguments arguments = written(text, first);
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
      };
      expect_refused(with(""), {});
      expect_refused(with(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\xff", 18)), {});
      Arguments missing = with(text.files[0].second);
      fs::remove(missing[0]);
      expect_refused(missing, {"no such file"});
    }
  }
  expect_refused({folder.write("notes.txt", "buy milk\n").string()},
                 {"no calibration that is known"});
  expect_refused({folder.path().string()}, {"no calibration that is known"});
}

TEST_F(RigImportSystem, OpencvFilesThatBreakOffAreRefused) {
  const std::string head = "<?xml version=\"1.0\"?>\n<opencv_storage>\n";
  const std::string matrix = "<M1 type_id=\"opencv-matrix\"><rows>3</rows></M1>\n";
  for (const std::string& text : {head,
                                  head + "<M1",
                                  head + "<M1 type_id=",  // OpenCV 4.6 reads on beyond the end
                                  head + matrix + "<R type_id=",
                                  head + matrix + "<R type_id=\"opencv-mat",
                                  opencv_text_up_to("data"),
                                  std::string("{\"opencv_storage\": {\"M1")}) {
    SCOPED_TRACE(text);
    const std::string file = folder.write("stereo.xml", text).string();
    expect_refused({file, "--format", "opencv"}, {});
  }
  std::string deep = head;
  for (int i = 0; i < 50000; ++i) {
    deep += "<a>";
  }
  expect_refused({folder.write("deep.xml", deep).string(), "--format", "opencv"}, {});
}

TEST_F(RigImportSystem, AnotherImageSizeIsRefused) {
  const CalibrationText text = testing::calibration_texts()[0];
  Arguments arguments = written(text, text.files[0].second);
  arguments.insert(arguments.end(), {"--size", "640x480"});
  expect_refused(arguments, {"752x480", "640x480"});
}

TEST_F(RigImportSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  const CalibrationText text = testing::calibration_texts()[0];
  const std::string in_the_way = folder.write("file", "in the way").string();
  for (const std::string& out :
       {(folder.path() / "no/such/folder.yaml").string(), in_the_way + "/rig.yaml"}) {
    Arguments arguments = written(text, text.files[0].second);
    arguments.insert(arguments.end(), {"-o", out});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr(out));
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_EQ(read_bytes(in_the_way), "in the way");
}

}  // namespace
}  // namespace skyhalo
