// The halo on the recorded KITTI drive: how often its nearest thing ahead is the laser's.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/recorded_data.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::ProgramResult;
using testing::recorded_drive;
using testing::TempFolder;

/// Compares halo and laser into `folder`/out and returns the summary.
nlohmann::json compare(const TempFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"halo",
                                     recorded_drive().string(),
                                     "--laser",
                                     "-o",
                                     (folder.path() / "out").string(),
                                     "--quiet",
                                     "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = testing::run_program(SKYHALO_PROGRAM, arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

TEST(RecordedHaloSystem, LaserAndHaloAgreeOnTheNearestThingAhead) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder folder;
  const nlohmann::json summary = compare(folder, {"--cone-deg", "20"});
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["frames_compared"], 72);
  RecordProperty("agreement", summary["agreement"].dump());
  EXPECT_GE(summary["agreement"].get<double>(), 0.90) << summary["disagreeing"].dump();
  EXPECT_GE(summary["supported"]["agreement"].get<double>(), 0.90);
  EXPECT_EQ(read_lines(folder.path() / "out/halo.csv").size(), 73U);  // a header and 72 frames
}

TEST(RecordedHaloSystem, OneAndTwoThreadsGiveTheSameBits) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder one;
  const TempFolder two;
  const std::vector<std::string> some{"--frames", "0:9", "--picture-frames", "5"};
  for (const auto& [folder, threads] : {std::pair(&one, "1"), {&two, "2"}}) {
    std::vector<std::string> arguments = some;
    arguments.insert(arguments.end(), {"--threads", threads});
    (void)compare(*folder, arguments);
  }
  for (const char* const name : {"halo.csv", "frame_000005.png"}) {
    EXPECT_EQ(read_bytes(one.path() / "out" / name), read_bytes(two.path() / "out" / name)) << name;
  }
}

}  // namespace
}  // namespace skyhalo
