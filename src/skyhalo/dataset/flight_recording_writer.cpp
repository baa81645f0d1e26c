#include "skyhalo/dataset/flight_recording_writer.hpp"

#include <cmath>
#include <utility>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/flight_files.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/dataset/stamp_text.hpp"
#include "skyhalo/io/disparity_image.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/pfm_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

/// Throws where a frame has something that the description does not speak of, or lacks it.
void check_sensors(const FlightFrame& frame, const FlightDescription& description, int number) {
  if (frame.scan && !description.T_body_laser) {
    throw frame_error(number, "has a scan, but the description no T_body_laser");
  }
  if (frame.scan) {
    check_scan(*frame.scan, number);
  }
  if (frame.sonar_m && !description.has_sonar) {
    throw frame_error(number, "has a sonar range, but the description no sonar");
  }
  if (frame.sonar_m && !(std::isfinite(*frame.sonar_m) && *frame.sonar_m >= 0.0)) {
    throw frame_error(number, "sonar: expected a range >= 0 m, or none");
  }
  if (!frame.objects.empty() && !description.has_objects) {
    throw frame_error(number, "has objects, but the description none");
  }
}

/// Throws for truth that cannot be of the rectified pair, whole or shrunk.
void check_truth(const PairTruth& truth, const StereoPair& pair, int number) {
  for (const cv::Mat1f& image : {truth.disparity_px, truth.range_m}) {
    if (image.cols > pair.image_size_px.width || image.rows > pair.image_size_px.height) {
      throw frame_error(number, pair.name + " truth: expected an image no larger than the pair's");
    }
  }
}

FlightDescription checked_description(FlightDescription description) {
  if (description.name.empty()) {
    throw Error(ErrorKind::kInput, "recording: expected a name");
  }
  if (description.T_body_laser && !is_rigid(*description.T_body_laser)) {
    throw Error(ErrorKind::kInput, "T_body_laser: expected a finite rigid transform");
  }
  return description;
}

}  // namespace

FlightRecordingWriter::FlightRecordingWriter(const fs::path& folder, FlightDescription description)
    : staged_(folder), description_(checked_description(std::move(description))) {
  expect_unused(staged_.folder());
  const fs::path rig_file = staged_.file("rig.yaml");
  write_bytes(rig_file, to_yaml(description_.rig, "the cameras of " + description_.name));
  rig_ = load_rig(rig_file);
}

void FlightRecordingWriter::add(const FlightFrame& frame) {
  check_fits(frame);
  write_pairs(frame);
  if (frame.scan) {
    write_velodyne(staged_.file(fs::path("laser") / frame_file_name(frame_count_, ".bin")),
                   *frame.scan);
  }
  add_rows(frame);
}

void FlightRecordingWriter::check_fits(const FlightFrame& frame) const {
  const int number = frame_count_;
  if (frame.images.stamp.time_since_epoch().count() < 0 ||
      (last_stamp_ && frame.images.stamp <= *last_stamp_)) {
    throw frame_error(number, "stamp: expected one after the frame before's, and after 1970");
  }
  const std::size_t pairs = rig_.pairs.size();
  if (frame.images.pairs.size() != pairs || (!frame.truth.empty() && frame.truth.size() != pairs)) {
    throw frame_error(number,
                      "expected images, and truth if any, of " + std::to_string(pairs) + " pairs");
  }
  for (std::size_t i = 0; i < pairs; ++i) {
    const StereoPair& pair = rig_.pairs[i];
    const StereoImages& images = frame.images.pairs[i];
    check_image(images.left, {left_image_size_px(pair)}, number, pair.name + " left image");
    check_image(images.right, {right_image_size_px(pair)}, number, pair.name + " right image");
    if (!frame.truth.empty()) {
      check_truth(frame.truth[i], pair, number);
    }
  }
  check_rigid(frame.T_map_body, number, "T_map_body");
  if (number > 0 && frame.true_pose.has_value() != has_true_poses_) {
    throw frame_error(number, "true_pose: expected in all frames or in none");
  }
  if (frame.true_pose) {
    check_rigid(*frame.true_pose, number, "true_pose");
  }
  for (const SceneObject& object : frame.objects) {
    check(object, number);
  }
  check_sensors(frame, description_, number);
}

void FlightRecordingWriter::write_pairs(const FlightFrame& frame) const {
  const std::string png = frame_file_name(frame_count_, ".png");
  for (std::size_t i = 0; i < rig_.pairs.size(); ++i) {
    const fs::path images = fs::path("images") / rig_.pairs[i].name;
    write_png(staged_.file(images / "left" / png), frame.images.pairs[i].left);
    write_png(staged_.file(images / "right" / png), frame.images.pairs[i].right);
  }
  for (std::size_t i = 0; i < frame.truth.size(); ++i) {
    const fs::path truth = fs::path("truth") / rig_.pairs[i].name;
    if (const cv::Mat1f& disparity_px = frame.truth[i].disparity_px; !disparity_px.empty()) {
      write_png(staged_.file(truth / "disparity" / png), disparity_image(disparity_px));
    }
    if (const cv::Mat1f& range_m = frame.truth[i].range_m; !range_m.empty()) {
      write_pfm(staged_.file(truth / "range" / frame_file_name(frame_count_, ".pfm")), range_m);
    }
  }
}

void FlightRecordingWriter::add_rows(const FlightFrame& frame) {
  const std::string row = std::to_string(frame_count_) + "," + stamp_text(frame.images.stamp);
  frames_csv_ += row + "\n";
  poses_ += pose_line(frame.T_map_body);
  if (frame.true_pose) {
    true_poses_ += pose_line(*frame.true_pose);
    has_true_poses_ = true;
  }
  sonar_csv_ += row + "," + (frame.sonar_m ? exact_number_text(*frame.sonar_m) : "") + "\n";
  for (const SceneObject& object : frame.objects) {
    objects_csv_ += object_line(object, frame_count_);
  }
  last_stamp_ = frame.images.stamp;
  ++frame_count_;
}

void FlightRecordingWriter::finish() {
  if (frame_count_ == 0) {
    throw Error(ErrorKind::kInput,
                "recording " + description_.name + ": expected at least one frame");
  }
  const auto write_table = [&](const char* name, const char* header, const std::string& rows) {
    write_bytes(staged_.file(name), std::string(header) + "\n" + rows);
  };
  write_table("frames.csv", kFramesHeader, frames_csv_);
  write_bytes(staged_.file("poses.txt"), poses_);
  if (has_true_poses_) {
    write_bytes(staged_.file("poses_true.txt"), true_poses_);
  }
  if (description_.has_sonar) {
    write_table("sonar.csv", kSonarHeader, sonar_csv_);
  }
  if (description_.has_objects) {
    write_table("objects.csv", kObjectsHeader, objects_csv_);
  }
  write_bytes(staged_.file(kFlightFile),
              to_json_text({.name = description_.name,
                            .source = description_.source,
                            .frames = frame_count_,
                            .T_body_laser = description_.T_body_laser,
                            .has_sonar = description_.has_sonar,
                            .has_objects = description_.has_objects,
                            .has_true_poses = has_true_poses_}));
  staged_.commit();
}

}  // namespace skyhalo
