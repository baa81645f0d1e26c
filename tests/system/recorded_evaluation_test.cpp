// The program on the recorded KITTI drive: the scores that the plain method must reach, and its
// files in the tools of others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/recorded_data.hpp"
#include "support/sanitised.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::ProgramResult;
using testing::recorded_drive;
using testing::recorded_labels;
using testing::run_program;
using testing::TempFolder;

/// Evaluates frames 0 to 71 into `folder`/out and returns the summary.
nlohmann::json evaluate(const TempFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"evaluate",
                                     recorded_drive().string(),
                                     "--labels",
                                     recorded_labels().string(),
                                     "--bounds",
                                     "0,120,-50,50,-3,2.5",
                                     "--out",
                                     (folder.path() / "out").string(),
                                     "--quiet",
                                     "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = run_program(SKYHALO_PROGRAM, arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

TEST(RecordedEvaluationSystem, OpencvsMatcherReachesThePlainMethodsScores) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  if (testing::kSanitised) {
    GTEST_SKIP() << "the next one runs the same code with our own matcher";
  }
  const TempFolder folder;
  const nlohmann::json summary = evaluate(folder, {"--set", "matching.matcher=opencv"});
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["frame"], 71);
  EXPECT_EQ(summary["cells"], 528000);
  EXPECT_NEAR(summary["occupied_cells"].get<double>(), 18024.0, 0.005 * 18024.0);
  EXPECT_GE(summary["precision"].get<double>(), 0.78);
  EXPECT_GE(summary["recall"].get<double>(), 0.20);
  EXPECT_GE(summary["correlation"].get<double>(), 0.48);
  for (const char* const name :
       {"metrics.csv", "table.md", "report.html", "ground_truth.ply", "map.ply", "summary.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / name)) << name;
  }
  EXPECT_EQ(read_lines(folder.path() / "out/metrics.csv").size(), 73U);  // a header and 72 frames
}

TEST(RecordedEvaluationSystem, OurMatcherMissesOnlyThePlainMethodsPrecision) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder folder;
  const nlohmann::json summary = evaluate(folder, {});
  ASSERT_TRUE(summary.is_object());
  EXPECT_GE(summary["precision"].get<double>(), 0.74);
  EXPECT_GE(summary["recall"].get<double>(), 0.23);
  EXPECT_GE(summary["correlation"].get<double>(), 0.48);
}

TEST(RecordedEvaluationSystem, OneAndTwoThreadsGiveTheSameBits) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder one;
  const TempFolder two;
  (void)evaluate(one, {"--frames", "0:9", "--threads", "1"});
  (void)evaluate(two, {"--frames", "0:9", "--threads", "2"});
  for (const char* const name : {"metrics.csv", "map.ply", "ground_truth.ply"}) {
    EXPECT_EQ(read_bytes(one.path() / "out" / name), read_bytes(two.path() / "out" / name)) << name;
  }
}

TEST(RecordedEvaluationSystem, PclReadsEveryPointWithItsColour) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder folder;
  const nlohmann::json summary = evaluate(folder, {"--frames", "0:9"});
  ASSERT_TRUE(summary.is_object());
  const ProgramResult pcl =
      run_program("/usr/bin/pcl_ply2pcd",
                  {(folder.path() / "out/map.ply").string(), (folder.path() / "map.pcd").string()},
                  folder.path());
  ASSERT_EQ(pcl.exit_code, 0) << pcl.err;
  const auto points = summary["tp"].get<int>() + summary["fp"].get<int>();
  EXPECT_GT(points, 0);
  const std::vector<std::string> header = read_lines(folder.path() / "map.pcd");
  EXPECT_THAT(header, ::testing::Contains("FIELDS x y z rgb"));
  EXPECT_THAT(header, ::testing::Contains("POINTS " + std::to_string(points)));
}

TEST(RecordedEvaluationSystem, OctomapsToolsReadTheMapOfARun) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder folder;
  const ProgramResult run = run_program(SKYHALO_PROGRAM,
                                        {"run",
                                         recorded_drive().string(),
                                         "--frames",
                                         "0:4",
                                         "--out",
                                         (folder.path() / "out").string(),
                                         "--quiet"},
                                        folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string tree = (folder.path() / "out/map.ot").string();
  const ProgramResult octomap =
      run_program("/usr/bin/compare_octrees", {tree, tree}, folder.path());
  EXPECT_EQ(octomap.exit_code, 0) << octomap.err;
  EXPECT_THAT(octomap.out + octomap.err, ::testing::HasSubstr("KLD: 0"));
}

}  // namespace
}  // namespace skyhalo
