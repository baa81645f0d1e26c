#include "skyhalo/dataset/flight_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/written_flight.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// A recording of two frames in a folder of its own.
class WrittenFlight {
 public:
  WrittenFlight() { testing::write_flight(path(), 2); }

  [[nodiscard]] fs::path path() const { return folder_.path() / "flight"; }

  [[nodiscard]] std::string text(const std::string& name) const {
    return testing::text_in(path() / name);
  }

  void write(const std::string& name, const std::string& text) const {
    (void)folder_.write("flight/" + name, text);
  }

  /// Replaces the first `from` in a file.
  void change(const std::string& name, const std::string& from, const std::string& to) const {
    std::string whole = text(name);
    const std::size_t at = whole.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(name, whole.replace(at, from.size(), to));
  }

  /// The complaint when it is opened.
  [[nodiscard]] std::string complaint() const {
    return message_of([&] { const FlightRecording flight(path()); });
  }

 private:
  TempFolder folder_;
};

/// The complaint about a recording in which the first `from` of a file has become `to`.
std::string complaint(const std::string& name, const std::string& from, const std::string& to) {
  const WrittenFlight flight;
  flight.change(name, from, to);
  return flight.complaint();
}

TEST(FlightRecordingTest, RecognisesARecording) {
  const WrittenFlight flight;
  EXPECT_TRUE(is_flight_recording(flight.path()));
  EXPECT_FALSE(is_flight_recording(flight.path().parent_path()));
  EXPECT_FALSE(is_flight_recording(flight.path() / "none"));
  EXPECT_FALSE(is_flight_recording(flight.path() / "flight.json"));
}

TEST(FlightRecordingTest, TheTruthCameraIsTheFirstPinholePairsRightOne) {
  const WrittenFlight written;
  const FlightRecording flight(written.path());
  const TruthCamera camera = flight.truth_camera();
  EXPECT_EQ(camera.focal_px, 256.0);
  EXPECT_EQ(camera.principal_u_px, 160.0);
  EXPECT_EQ(camera.principal_v_px, 48.0);
  EXPECT_EQ(camera.image_size_px, cv::Size(320, 96));
  // 8.25 m ahead of the right camera at (1, -0.25, 0.375), 1 m to its right and 0.5 m below, seen
  // from the scanner at (0.75, 0, 0.5).
  EXPECT_TRUE((camera.T_camera_laser * Eigen::Vector3d(8.5, -1.25, -0.625))
                  .isApprox(Eigen::Vector3d(1.0, 0.5, 8.25), 1e-12));
}

TEST(FlightRecordingTest, WithoutAPinholePairThereIsNoTruthCamera) {
  const TempFolder folder;
  FlightDescription description = testing::full_flight();
  description.rig.pairs.erase(description.rig.pairs.begin());
  FlightFrame frame = testing::bare_frame(0);
  frame.images.pairs.erase(frame.images.pairs.begin());
  FlightRecordingWriter writer(folder.path() / "flight", description);
  writer.add(frame);
  writer.finish();
  const FlightRecording flight(folder.path() / "flight");
  EXPECT_THAT(message_of([&] { (void)flight.truth_camera(); }),
              HasSubstr("rig.yaml: expected a pinhole pair"));
}

TEST(FlightRecordingTest, BoxesAreSeenFromTheTruePose) {
  // The body is truly at (10, 0, 2), looking left; it believes to be at the origin. A car at
  // (10, 8, 0) is 8 m ahead of it.
  const TempFolder folder;
  FlightFrame frame = testing::bare_frame(0);
  frame.T_map_body = Pose::Identity();
  frame.true_pose = make_pose(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
      {10.0, 0.0, 2.0});
  frame.objects = {testing::upright_object(1, {10.0, 8.0, 0.0}, 0.0)};
  FlightRecordingWriter writer(folder.path() / "flight", testing::full_flight());
  writer.add(frame);
  writer.finish();
  const FlightRecording flight(folder.path() / "flight");
  const std::vector<OrientedBox> boxes = flight.boxes_in_body(0);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_TRUE(contains(boxes[0], {8.9, 2.0, -1.9}));  // 4.1 m long, across the way
  EXPECT_TRUE(contains(boxes[0], {7.1, -2.0, -0.6}));
  EXPECT_FALSE(contains(boxes[0], {9.1, 0.0, -1.0}));
  EXPECT_FALSE(contains(boxes[0], {8.0, 0.0, -0.4}));
}

TEST(FlightRecordingTest, AnotherRigTakesThePlaceOfTheRecordings) {
  const WrittenFlight written;
  StereoRig rig = FlightRecording(written.path()).rig();
  rig.pairs[0].name = "ahead";
  const FlightRecording flight(written.path(), rig);
  EXPECT_EQ(flight.rig().pairs[0].name, "ahead");
  EXPECT_EQ(flight.read(1).pairs.size(), 2U);
  rig.pairs.pop_back();
  EXPECT_THAT(message_of([&] { const FlightRecording f(written.path(), rig); }),
              HasSubstr("the recording has 2 pairs, the rig that is to replace it 1"));
}

TEST(FlightRecordingTest, WhatIsWrongInTheHeadIsNamed) {
  const std::string file = "flight.json";
  EXPECT_THAT(complaint(file, "skyhalo-flight", "other"),
              AllOf(HasSubstr("flight.json:2: format: expected 'skyhalo-flight'")));
  EXPECT_THAT(complaint(file, "\"version\": 1", "\"version\": 2"),
              HasSubstr("flight.json:3: version: version 2 is not known; this program reads"));
  EXPECT_THAT(complaint(file, "\"version\"", "\"edition\""), HasSubstr("version: this key is mis"));
  EXPECT_THAT(complaint(file, "\"frames\": 2", "\"frames\": 0"), HasSubstr("at least one frame"));
  EXPECT_THAT(complaint(file, "\"frames\": 2", "\"frames\": 2.5"), HasSubstr("a whole number"));
  EXPECT_THAT(complaint(file, "\"frames\": 2", "\"frames\": 3"),
              HasSubstr("frames.csv: has 2 lines of data, expected one for each of 3 frames"));
  EXPECT_THAT(complaint(file, "\"frames\": 2", "\"frames\": 1"), HasSubstr("frames.csv"));
  EXPECT_THAT(complaint(file, "\"sonar\": true", "\"sonar\": 1"),
              HasSubstr("sonar: expected true"));
  EXPECT_THAT(complaint(file, "\"sonar\"", "\"radar\""), HasSubstr("radar: unknown key"));
  EXPECT_THAT(complaint(file, "0.75", "NaN"), HasSubstr("laser.T_body_laser"));
  EXPECT_THAT(complaint(file, "1.0", "2.0"), HasSubstr("the four rows of a rigid transform"));
  EXPECT_THAT(complaint(file, "\"frames\": 2", ""), HasSubstr("flight.json"));
  EXPECT_THAT(complaint(file, "{", "["), HasSubstr("flight.json"));
}

TEST(FlightRecordingTest, WhatIsWrongInATableIsNamed) {
  const std::string frames = "frames.csv";
  EXPECT_THAT(complaint(frames, "frame,stamp_ns", "stamp"), HasSubstr("frames.csv:1: expected"));
  EXPECT_THAT(complaint(frames, "\n1,", "\n2,"), HasSubstr("frames.csv:3: column 1: expected fra"));
  EXPECT_THAT(complaint(frames, "\n1,1", "\n1,0"),
              HasSubstr("frames.csv:3: the time stamp is not"));
  EXPECT_THAT(complaint(frames, "\n0,1", "\n0,-1"), HasSubstr(":2: column 2: expected whole nano"));
  EXPECT_THAT(complaint(frames, "\n0,1", "\n0,1.5"),
              HasSubstr(":2: column 2: expected whole nano"));
  EXPECT_THAT(complaint(frames, "\n0,", "\n0,7,"), HasSubstr(":2: expected 2 values"));
  const std::string sonar = "sonar.csv";
  EXPECT_THAT(complaint(sonar, ",0.1\n", ",nan\n"),
              HasSubstr("sonar.csv:2: column 3: expected a "));
  EXPECT_THAT(complaint(sonar, ",0.1\n", ",-0.1\n"), HasSubstr("a range >= 0 m, or nothing"));
  EXPECT_THAT(complaint(sonar, "00001,", "00002,"),
              HasSubstr("sonar.csv:2: column 2: expected th"));
  const std::string objects = "objects.csv";
  EXPECT_THAT(complaint(objects, "\n0,4,", "\n2,4,"),
              HasSubstr("objects.csv:2: column 1: expected a frame in 0...1"));
  EXPECT_THAT(complaint(objects, "\n0,4,", "\n-1,4,"), HasSubstr("objects.csv:2: column 1"));
  EXPECT_THAT(complaint(objects, ",Car,", ",,"),
              HasSubstr("objects.csv:2: frame 0: object 4: exp"));
  EXPECT_THAT(complaint(objects, ",4.1,", ",0,"), HasSubstr("above 0 m"));
  EXPECT_THAT(complaint(objects, ",4.1,", ",inf,"), HasSubstr(":2: column 8: expected a finite"));
}

TEST(FlightRecordingTest, WhatIsWrongInThePosesIsNamed) {
  for (const std::string name : {"poses.txt", "poses_true.txt"}) {
    const WrittenFlight flight;
    const std::string good = flight.text(name);
    const std::string first = good.substr(0, good.find('\n') + 1);
    const auto refused = [&](const std::string& text) {
      flight.write(name, text);
      return flight.complaint();
    };
    EXPECT_THAT(refused(first), HasSubstr(name + ": has 1 lines of data, expected one for each"));
    EXPECT_THAT(refused(good + first), HasSubstr("has 3 lines of data"));
    EXPECT_THAT(refused(first + "1 2 3\n"), HasSubstr(name + ":2: expected 12 numbers, found 3"));
    EXPECT_THAT(refused("1 0 0 0 0 1 0 0 0 0 1 nan\n" + first),
                HasSubstr(name + ":1: value 12: expected a finite number, found 'nan'"));
    EXPECT_THAT(refused("1 0 0 0 0 1 0 0 0 0 -1 0\n" + first), HasSubstr("rotation matrix"));
    fs::remove(flight.path() / name);
    EXPECT_THAT(flight.complaint(), HasSubstr(name + ": no such file"));
  }
}

TEST(FlightRecordingTest, AHostilePairNameIsRefused) {
  for (const std::string name : {"../x", "/etc", "..", ".hidden", "a\\\\b", ""}) {
    EXPECT_THAT(complaint("rig.yaml", "\"front\"", "\"" + name + "\""),
                AllOf(HasSubstr("rig.yaml:"), HasSubstr("pairs[0].name")));
  }
}

TEST(FlightRecordingTest, AMissingImageIsNamedAtOnce) {
  const WrittenFlight flight;
  fs::remove(flight.path() / "images/rear/left/000001.png");
  EXPECT_THAT(flight.complaint(),
              HasSubstr("images/rear/left/000001.png: is missing: frame 1 of 2"));
}

TEST(FlightRecordingTest, FaultyDataIsNamedWhenItIsRead) {
  const WrittenFlight written;
  const FlightRecording flight(written.path());
  write_png(written.path() / "images/front/right/000001.png", testing::texture({10, 10}, 1));
  EXPECT_THAT(message_of([&] { (void)flight.read(1); }),
              HasSubstr("front/right/000001.png: has 10x10 pixels, expected 320x96"));
  written.write("laser/000001.bin", "12345");
  EXPECT_THAT(message_of([&] { (void)flight.read_scan(1); }), HasSubstr("000001.bin: is cut off"));
  write_png(written.path() / "truth/front/disparity/000001.png", testing::texture({10, 10}, 1));
  EXPECT_THAT(message_of([&] { (void)flight.true_disparity_px(1, 0); }), HasSubstr("of 16 bits"));
  written.write("truth/front/range/000001.pfm", "Pf\n3 3\n-1.0\n");
  EXPECT_THAT(message_of([&] { (void)flight.true_range_m(1, 0); }), HasSubstr("000001.pfm"));
}

}  // namespace
}  // namespace skyhalo
