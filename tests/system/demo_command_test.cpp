// The demo through the program, with fewer frames than it has by itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/room_flight.hpp"
#include "support/sanitised.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::operator+;
using testing::ProgramResult;

TEST(DemoCommandSystem, FliesTheReferencePlatformAndWritesAPageThatOpensOffline) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser; the next test runs the same code there";
  }
  const testing::TempFolder root;
  const std::string out = (root.path() / "demo").string();
  const ProgramResult result = testing::run_program(SKYHALO_PROGRAM,
                                                    {"demo",
                                                     "--scene",
                                                     "tunnel",
                                                     "--difficulty",
                                                     "0",
                                                     "--frames",
                                                     "4",
                                                     "--samples",
                                                     "1",
                                                     "--out",
                                                     out,
                                                     "--json"},
                                                    root.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("precision"));
  EXPECT_THAT(result.out, HasSubstr("report.html"));
  const auto summary = nlohmann::json::parse(read_bytes(out + "/summary.json"));
  EXPECT_EQ(summary["frame_sets"], 4);
  EXPECT_EQ(summary["pairs"], 4);
  for (const char* key : {"precision", "recall", "frame_sets_per_s"}) {
    EXPECT_GT(summary[key].get<double>(), 0.0) << key;
  }
  for (const char* stage : {"rectify", "match", "sphere", "stitch", "map"}) {
    EXPECT_TRUE(summary["stages"].contains(stage)) << stage;
  }
  EXPECT_EQ(nlohmann::json::parse(result.out.substr(result.out.rfind("\n{") + 1))["recall"],
            summary["recall"]);
  const std::string page = read_bytes(out + "/report.html");
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("SKYHALO_CONTENT")));
  EXPECT_THAT(read_bytes(out + "/map.ply"), ::testing::StartsWith("ply"));
  EXPECT_THAT(read_bytes(out + "/overview.png"), HasSubstr("PNG"));
}

/// A demo with a small rig through a room.
ProgramResult small_demo(const testing::TempFolder& root, const testing::Arguments& more) {
  const std::string folder = root.path().string();
  write_bytes(folder + "/room.obj", testing::kRoom);
  write_bytes(folder + "/path.csv", "x_m,y_m,z_m\n-5,0,2\n0,2,2\n5,0,3\n");
  return testing::run_program(SKYHALO_PROGRAM,
                              testing::Arguments{"demo",
                                                 "--scene",
                                                 folder + "/room.obj",
                                                 "--trajectory",
                                                 folder + "/path.csv",
                                                 "--rig",
                                                 folder + "/rig.yaml",
                                                 "--out",
                                                 folder + "/demo",
                                                 "--quiet",
                                                 "--json"} +
                                  more,
                              root.path());
}

TEST(DemoCommandSystem, FliesYourOwnRigThroughYourOwnMesh) {
  const testing::TempFolder root;
  (void)root.write("rig.yaml", testing::kSmallRig);
  const ProgramResult result = small_demo(root, {"--frames", "5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["frame_sets"], 5);
  EXPECT_EQ(summary["pairs"], 1);
  EXPECT_EQ(summary["flown_through_occupied"], 0);
  // A rate alone is enough: the usual number of frames is nobody's wish.
  EXPECT_EQ(small_demo(root, {"--rate", "1", "--samples", "1"}).exit_code, 0);
}

/// Images are rendered at half the rig's size; a mask is still in the rig's pixels.
TEST(DemoCommandSystem, MasksAreInTheRigsPixels) {
  const testing::TempFolder root;
  std::string rig = testing::kSmallRig;
  rig.replace(rig.find("downscale: 1"), 12, "downscale: 2");
  (void)root.write("rig.yaml", rig);
  const auto density = [&](const testing::Arguments& more) {
    const ProgramResult result =
        small_demo(root, testing::Arguments{"--frames", "2", "--samples", "1"} + more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["disparity"]["front"]["density"].get<double>();
  };
  const double whole = density({});
  EXPECT_GT(whole, 0.3);
  EXPECT_EQ(density({"--set", "matching.masks_px=[[0,0,160,120]]"}), 0.0);
  EXPECT_NEAR(density({"--set", "matching.masks_px=[[0,0,160,60]]"}) +
                  density({"--set", "matching.masks_px=[[0,60,160,60]]"}),
              whole,
              1e-6);
}

TEST(DemoCommandSystem, AnUnknownSceneLeavesNothing) {
  const testing::TempFolder root;
  const std::string out = (root.path() / "demo").string();
  const ProgramResult result = testing::run_program(
      SKYHALO_PROGRAM, {"demo", "--scene", "atlantis", "--out", out}, root.path());
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(DemoCommandSystem, HelpIsNoErrorAndListsWhatEveryCommandTakes) {
  const testing::TempFolder root;
  EXPECT_THAT(testing::run_program(SKYHALO_PROGRAM, {"--help"}, root.path()).out,
              HasSubstr("demo"));
  const ProgramResult result =
      testing::run_program(SKYHALO_PROGRAM, {"demo", "--help"}, root.path());
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string option : {"--config", "--set", "--threads", "--json", "--quiet"}) {
    EXPECT_THAT(result.out, HasSubstr(option));
  }
}

}  // namespace
}  // namespace skyhalo
