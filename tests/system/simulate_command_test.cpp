// Simulated flights through the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/room_flight.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Arguments;
using testing::operator+;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::TempFolder;

class SimulateCommandSystem : public ::testing::Test {
 protected:
  SimulateCommandSystem() {
    write("room.obj", testing::kRoom);
    write("rig.yaml", testing::kSmallRig);
    write("path.csv", "x_m,y_m,z_m\n-5,0,2\n0,2,2\n5,0,3\n");
  }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root.path() / name).parent_path());
    replace_file(root.path() / name, text);
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return (root.path() / name).string();
  }

  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, arguments, root.path());
  }

  /// A flight through the room into `out`, where `more` does not say otherwise.
  [[nodiscard]] ProgramResult simulate(const Arguments& more) const {
    const Arguments usual{"--scene",
                          at("room.obj"),
                          "--rig",
                          at("rig.yaml"),
                          "--trajectory",
                          at("path.csv"),
                          "--frames",
                          "3",
                          "--samples",
                          "1",
                          "--out",
                          at("out")};
    Arguments arguments{"simulate"};
    for (std::size_t i = 0; i < usual.size(); i += 2) {
      if (std::find(more.begin(), more.end(), usual[i]) == more.end()) {
        arguments = arguments + Arguments{usual[i], usual[i + 1]};
      }
    }
    return run(arguments + more);
  }

  void expect_bad_input(const Arguments& more, const std::string& words) const {
    const ProgramResult result = simulate(more);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_FALSE(fs::exists(at("out")));
  }

  TempFolder root;
};

TEST_F(SimulateCommandSystem, WritesARecordingThatRunsWithItsTruth) {
  const ProgramResult simulated = simulate({"--json"});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  EXPECT_THAT(simulated.out, HasSubstr("\"frames\":3"));
  for (const char* name : {"flight.json",
                           "rig.yaml",
                           "poses_true.txt",
                           "images/front/left/000002.png",
                           "laser/000002.bin",
                           "truth/front/disparity/000002.png",
                           "truth/exact.skymap",
                           "truth/seen.skymap"}) {
    EXPECT_TRUE(fs::exists(fs::path(at("out")) / name)) << name;
  }
  const ProgramResult mapped = run({"run", at("out"), "--out", at("run"), "--quiet", "--json"});
  EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
  EXPECT_THAT(mapped.out, HasSubstr("\"frames\":3"));
}

TEST_F(SimulateCommandSystem, WritesAKittiSequenceThatEvaluateTakes) {
  const ProgramResult simulated = simulate({"--format", "kitti-tracking", "--sequence", "3"});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  EXPECT_THAT(simulated.out, HasSubstr("skyhalo evaluate " + at("out") + " --sequence 0003"));
  EXPECT_TRUE(fs::exists(at("out/training/label_02/0003.txt")));
  const ProgramResult evaluated =
      run({"evaluate", at("out"), "--out", at("evaluated"), "--quiet", "--json"});
  EXPECT_EQ(evaluated.exit_code, 0) << evaluated.err;
  EXPECT_THAT(evaluated.out, HasSubstr("\"sequence\":\"0003\""));
}

TEST_F(SimulateCommandSystem, WritesAEurocFlightThatRuns) {
  const ProgramResult simulated = simulate({"--format", "euroc"});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const ProgramResult mapped = run({"run", at("out"), "--out", at("run"), "--quiet"});
  EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
  // The ground truth is exact, so there is no place for poses that err.
  const ProgramResult erring = simulate({"--format", "euroc", "--ins-noise", "1,5"});
  EXPECT_EQ(erring.exit_code, 2);
  EXPECT_THAT(erring.err, HasSubstr("true poses only"));
}

TEST_F(SimulateCommandSystem, TheSameSeedWritesTheSameBytes) {
  ASSERT_EQ(simulate({"--seed", "5", "--ins-noise", "0.1,1"}).exit_code, 0);
  fs::rename(at("out"), at("first"));
  ASSERT_EQ(simulate({"--seed", "5", "--ins-noise", "0.1,1", "--threads", "1"}).exit_code, 0);
  int files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(at("first"))) {
    if (entry.is_regular_file()) {
      const fs::path relative = fs::relative(entry.path(), at("first"));
      EXPECT_EQ(read_bytes(fs::path(at("out")) / relative), read_bytes(entry.path())) << relative;
      ++files;
    }
  }
  // Two images, scan and two truths of three frames, seven tables, two maps.
  EXPECT_EQ(files, 3 * 5 + 9);
}

TEST_F(SimulateCommandSystem, AnUnknownSceneIsNamedWithTheKnownOnes) {
  expect_bad_input({"--scene", "atlantis"}, "atlantis");
  EXPECT_THAT(simulate({"--scene", "atlantis"}).err, HasSubstr("forest"));
}

TEST_F(SimulateCommandSystem, MeshesThatCannotBeUsedAreNamed) {
  expect_bad_input({"--scene", at("none.obj")}, "none.obj");
  write("empty.obj", "# nothing\n");
  expect_bad_input({"--scene", at("empty.obj")}, "empty.obj");
  write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_bad_input({"--scene", at("nan.obj")}, "nan.obj");
}

TEST_F(SimulateCommandSystem, ATrajectoryThroughAWallIsReportedWithItsPlace) {
  write("out.csv", "x_m,y_m,z_m\n-5,0,2\n15,0,2\n");
  expect_bad_input({"--trajectory", at("out.csv")}, "passes through the scene");
  const ProgramResult result = simulate({"--trajectory", at("out.csv"), "--may-collide"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning"), HasSubstr("passes through the scene")));
}

TEST_F(SimulateCommandSystem, TrajectoriesThatCannotBeFlownAreNamed) {
  expect_bad_input({"--trajectory", at("none.csv")}, "none.csv");
  write("short.csv", "x_m,y_m,z_m\n-5,0,2\n");
  expect_bad_input({"--trajectory", at("short.csv")}, "short.csv");
  expect_bad_input({"--trajectory", "route"}, "no route");
}

TEST_F(SimulateCommandSystem, CirclesAndHoversKeepClear) {
  for (const std::string trajectory : {"orbit", "hover"}) {
    const ProgramResult result =
        simulate({"--scene", "fence", "--trajectory", trajectory, "--frames", "1", "--no-truth"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    fs::remove_all(at("out"));
  }
}

TEST_F(SimulateCommandSystem, OptionsThatMeanNothingInALayoutAreRefused) {
  const auto complaint = [&](const Arguments& arguments) {
    const ProgramResult result = simulate(arguments);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(complaint({"--sequence", "1"}), HasSubstr("has sequences"));
  EXPECT_THAT(complaint({"--format", "euroc", "--no-truth"}), HasSubstr("--no-truth"));
  EXPECT_THAT(complaint({"--format", "kitti-tracking", "--no-laser"}), HasSubstr("--no-laser"));
  EXPECT_THAT(complaint({"--pair", "rear"}), HasSubstr("--pair rear: the rig has front"));
  expect_bad_input({"--rate", "nan"}, "rate_hz");
  expect_bad_input({"--body-radius", "nan"}, "the body's radius");
}

TEST_F(SimulateCommandSystem, AFolderThatHoldsSomethingIsLeftAsItIs) {
  write("kept/file.txt", "mine");
  const ProgramResult result = simulate({"--out", at("kept")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(read_bytes(at("kept/file.txt")), "mine");
}

TEST_F(SimulateCommandSystem, WrongUsageSaysWhatIsExpected) {
  EXPECT_EQ(simulate({"--samples", "3"}).exit_code, 2);
  EXPECT_EQ(simulate({"--format", "rosbag"}).exit_code, 2);
  const ProgramResult many = simulate({"--frames", "1000", "--rate", "5"});
  EXPECT_EQ(many.exit_code, 2);
  EXPECT_THAT(many.err, HasSubstr("frames at 5 Hz"));
  EXPECT_EQ(simulate({"--format", "euroc", "--pair", "rear"}).exit_code, 2);
  const ProgramResult slow = simulate({"--format", "kitti-tracking", "--rate", "5"});
  EXPECT_EQ(slow.exit_code, 2);
  EXPECT_THAT(slow.err, HasSubstr("10 Hz"));
}

}  // namespace
}  // namespace skyhalo
