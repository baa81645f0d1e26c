// Recordings of every layout through the program: the same drive towards a wall, written as KITTI's
// tracking benchmark and as a recording of skyhalo's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "skyhalo/dataset/euroc_writer.hpp"
#include "skyhalo/dataset/flight_recording_writer.hpp"
#include "skyhalo/dataset/kitti_tracking_writer.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/synthetic_drive.hpp"
#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using testing::operator+;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::SyntheticDrive;
using testing::TempFolder;

/// Settings that suit the small pictures: a search of 32 pixels at full resolution.
const Arguments kSmallPictures{"--set",
                               "matching.downscale=1",
                               "--set",
                               "matching.max_disparity_px=32",
                               "--set",
                               "matching.rcrop_px=16"};

/// A box about the middle of the wall, in the map: 2 m deep, 4 m wide, 10 m high.
SceneObject box_in_the_wall() {
  SceneObject object{.track = 1, .type = "Truck"};
  object.size_m = {2.0, 4.0, 10.0};
  object.T_map_object = make_pose(Eigen::Matrix3d::Identity(), {9.25, 0.0, -5.0});
  return object;
}

class RecordingsCommandSystem : public ::testing::Test {
 protected:
  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, arguments, root.path());
  }

  /// A command on a recording, with results in `out`.
  [[nodiscard]] ProgramResult run_on(const std::string& command,
                                     const fs::path& source,
                                     const Arguments& more = {}) const {
    return run(Arguments{command, source.string(), "--out", (root.path() / "out").string()} +
               kSmallPictures + more);
  }

  [[nodiscard]] json summary() const {
    return json::parse(read_bytes(root.path() / "out/summary.json"));
  }

  [[nodiscard]] int occupied_cells(const fs::path& source, const Arguments& more = {}) const {
    const ProgramResult r = run_on("evaluate", source, more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return r.exit_code == 0 ? summary()["occupied_cells"].get<int>() : -1;
  }

  /// The pair of the made-up drive.
  [[nodiscard]] PairDescription pair() const {
    return {.name = "front",
            .images = RectifiedPairDescription{world.image_size_px,
                                               PinholePair{world.focal_px,
                                                           world.principal_u_px,
                                                           world.principal_v_px,
                                                           world.baseline_m}},
            .T_body_camera = testing::forward_pair().T_body_camera};
  }

  [[nodiscard]] StereoImages images_at(double x_m) const {
    return {testing::wall_picture(world, {x_m + 1.0, 0.25, 0.375}),
            testing::wall_picture(world, {x_m + 1.0, 0.25 - world.baseline_m, 0.375})};
  }

  [[nodiscard]] LaserReturns scan_at(double x_m) const {
    const std::string bytes = testing::wall_scan(world, x_m);
    LaserReturns scan;
    for (std::size_t at = 0; at < bytes.size(); at += 16) {
      Eigen::Vector3f p_m;
      std::memcpy(p_m.data(), bytes.data() + at, 12);
      scan.points_m.push_back(p_m);
    }
    return scan;
  }

  static Pose pose_at(double x_m) {
    return make_pose(Eigen::Matrix3d::Identity(), {x_m, 0.0, 0.0});
  }

  /// Writes the drive as a tracking sequence and returns the folder.
  [[nodiscard]] fs::path write_tracking(int sequence,
                                        const std::vector<SceneObject>& objects = {}) const {
    const StereoRig rig = resolve({.name = "", .T_body_imu = {}, .pairs = {pair()}});
    KittiTrackingWriter writer(
        root.path() / "kitti", sequence, {rig.pairs[0], testing::laser_place()});
    for (int frame = 0; frame < world.frames; ++frame) {
      const double x_m = frame * world.step_m;
      writer.add({.images = images_at(x_m),
                  .T_map_body = pose_at(x_m),
                  .scan = scan_at(x_m),
                  .objects = objects});
    }
    writer.finish();
    return root.path() / "kitti";
  }

  /// Writes the drive as a recording of skyhalo's own and returns the folder.
  [[nodiscard]] fs::path write_flight(bool has_laser,
                                      const std::vector<SceneObject>& objects = {},
                                      bool has_objects = true) const {
    FlightDescription description{
        .name = "towards a wall",
        .source = {},
        .rig = {.name = "test", .T_body_imu = {}, .pairs = {pair()}},
        .T_body_laser = has_laser ? std::optional(testing::laser_place()) : std::nullopt,
        .has_objects = has_objects};
    FlightRecordingWriter writer(root.path() / "flight", description);
    for (int i = 0; i < world.frames; ++i) {
      const double x_m = i * world.step_m;
      FlightFrame frame;
      frame.images = {Timestamp(std::chrono::milliseconds(125 * i)), {images_at(x_m)}};
      frame.T_map_body = pose_at(x_m);
      frame.scan = has_laser ? std::optional(scan_at(x_m)) : std::nullopt;
      frame.objects = objects;
      writer.add(frame);
    }
    writer.finish();
    return root.path() / "flight";
  }

  SyntheticDrive world;
  TempFolder root;
};

TEST_F(RecordingsCommandSystem, ATrackingSequenceIsScoredLikeTheRawDrive) {
  const fs::path drive = testing::write_drive(world, root.path() / "raw").drive;
  const int expected = occupied_cells(drive);
  EXPECT_GT(expected, 100);
  const fs::path folder = write_tracking(5);
  EXPECT_EQ(occupied_cells(folder), expected);  // an empty label file: nothing moves
  EXPECT_EQ(summary()["sequence"], "0005");
  EXPECT_EQ(summary()["labelled"], true);
  EXPECT_EQ(occupied_cells(folder / "training", {"--format", "kitti-tracking"}), expected);
}

TEST_F(RecordingsCommandSystem, ATrackingSequencesOwnLabelsAreTaken) {
  const int all = occupied_cells(write_tracking(1));
  const fs::path folder = write_tracking(2, {box_in_the_wall()});
  const int fewer = occupied_cells(folder, {"--sequence", "0002"});
  // Of the wall's columns of cells, the eight within 2 m to both sides are in the box.
  EXPECT_LT(fewer, all - 20);
  EXPECT_GT(fewer, 0);
  EXPECT_EQ(occupied_cells(folder, {"--sequence", "0001"}), all);
}

TEST_F(RecordingsCommandSystem, OneOfSeveralSequencesMustBeChosen) {
  const fs::path folder = write_tracking(1);
  (void)write_tracking(2);
  for (const std::string command : {"run", "evaluate", "halo"}) {
    const ProgramResult none = run_on(command, folder);
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_THAT(none.err, HasSubstr("--sequence: expected one of 0001 0002"));
    const ProgramResult other = run_on(command, folder, {"--sequence", "0003"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.err, AllOf(HasSubstr("--sequence 0003: "), HasSubstr(" has 0001 0002")));
  }
  EXPECT_EQ(run_on("run", folder, {"--sequence", "0002"}).exit_code, 0);
  EXPECT_EQ(summary()["source"], "0002");
  const fs::path flight = write_flight(false);
  const ProgramResult r = run_on("run", flight, {"--sequence", "0002"});
  EXPECT_EQ(r.exit_code, 2);
  EXPECT_THAT(r.err, HasSubstr("only folders of KITTI's tracking benchmark have sequences"));
}

TEST_F(RecordingsCommandSystem, ARecordingOfOurOwnIsScored) {
  const int expected = occupied_cells(write_flight(true));
  EXPECT_GT(expected, 100);
  EXPECT_EQ(summary()["source"], "towards a wall");
  EXPECT_EQ(summary()["labelled"], true);
  EXPECT_GT(summary()["tp"], 0);
  const ProgramResult labels =
      run_on("evaluate", root.path() / "flight", {"--labels", "label_02_0003.txt"});
  EXPECT_EQ(labels.exit_code, 2);
  EXPECT_THAT(labels.err, HasSubstr("has its boxes in objects.csv"));
  fs::remove_all(root.path() / "flight");
  EXPECT_LT(occupied_cells(write_flight(true, {box_in_the_wall()})), expected - 20);
  fs::remove_all(root.path() / "flight");
  EXPECT_EQ(occupied_cells(write_flight(true, {}, false)), expected);
  EXPECT_EQ(summary()["labelled"], false);
}

TEST_F(RecordingsCommandSystem, ARecordingWithoutLaserIsMappedButNotScored) {
  const fs::path flight = write_flight(false);
  EXPECT_EQ(run_on("run", flight).exit_code, 0);
  EXPECT_EQ(summary()["frames"], world.frames);
  const ProgramResult evaluated = run_on("evaluate", flight);
  EXPECT_EQ(evaluated.exit_code, 3);
  EXPECT_THAT(evaluated.err, HasSubstr("is no recording with a laser scanner"));
  const ProgramResult halo = run_on("halo", flight, {"--laser"});
  EXPECT_EQ(halo.exit_code, 3);
  EXPECT_THAT(halo.err, HasSubstr("has no laser scanner to compare with"));
  EXPECT_EQ(run_on("halo", flight).exit_code, 0);
  EXPECT_EQ(run({"rectify", flight.string(), "-o", (root.path() / "rectified").string()}).exit_code,
            0);
}

TEST_F(RecordingsCommandSystem, AFlightThatWasWrittenIsMapped) {
  EurocWriter writer(root.path() / "flight", pair());
  for (int i = 0; i < world.frames; ++i) {
    const double x_m = i * world.step_m;
    writer.add({Timestamp(std::chrono::milliseconds(125 * i)), pose_at(x_m)}, images_at(x_m));
  }
  writer.finish();
  const ProgramResult r = run_on("run", root.path() / "flight");
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_EQ(summary()["frames"], world.frames);
}

TEST_F(RecordingsCommandSystem, AnUnknownFolderSaysWhatIsKnown) {
  const ProgramResult r = run_on("run", root.path());
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err,
              AllOf(HasSubstr("KITTI raw drive"),
                    HasSubstr("KITTI tracking folder"),
                    HasSubstr("EuRoC"),
                    HasSubstr("flight.json")));
}

}  // namespace
}  // namespace skyhalo
