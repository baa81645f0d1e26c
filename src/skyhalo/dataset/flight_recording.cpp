#include "skyhalo/dataset/flight_recording.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/flight_files.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/pfm_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

cv::Mat1f disparities_of(const fs::path& file) {
  const cv::Mat image = read_image(file);
  if (image.type() != CV_16UC1) {
    throw input_error(file, "expected a grey image of 16 bits, 256 times the disparity");
  }
  constexpr float kPxPerUnit = 1.0F / 256.0F;
  cv::Mat1f disparity_px(image.size());
  std::transform(image.begin<std::uint16_t>(),
                 image.end<std::uint16_t>(),
                 disparity_px.begin(),
                 [](std::uint16_t units) {
                   return units == 0 ? std::numeric_limits<float>::quiet_NaN()
                                     : static_cast<float>(units) * kPxPerUnit;
                 });
  return disparity_px;
}

}  // namespace

bool is_flight_recording(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / kFlightFile, ignored);
}

FlightRecording::FlightRecording(const fs::path& folder, std::optional<StereoRig> rig)
    : folder_(folder) {
  FlightHead head = read_flight_head(folder_ / kFlightFile);
  name_ = std::move(head.name);
  source_ = std::move(head.source);
  T_body_laser_ = head.T_body_laser;
  use_rig(std::move(rig));
  stamps_ = read_flight_stamps(folder_ / "frames.csv", head.frames);
  poses_ = read_flight_poses(folder_ / "poses.txt", head.frames);
  if (head.has_true_poses) {
    true_poses_ = read_flight_poses(folder_ / "poses_true.txt", head.frames);
  }
  if (head.has_sonar) {
    sonar_m_ = read_flight_sonar(folder_ / "sonar.csv", stamps_);
  }
  if (head.has_objects) {
    objects_ = read_flight_objects(folder_ / "objects.csv", head.frames);
  }
  expect_images();
}

void FlightRecording::use_rig(std::optional<StereoRig> rig) {
  const fs::path file = folder_ / "rig.yaml";
  rig_ = load_rig(file);
  for (const StereoPair& pair : rig_.pairs) {
    pair_names_.push_back(pair.name);
  }
  if (rig && rig->pairs.size() != rig_.pairs.size()) {
    throw input_error(file,
                      "the recording has " + std::to_string(rig_.pairs.size()) +
                          " pairs, the rig that is to replace it " +
                          std::to_string(rig->pairs.size()));
  }
  if (rig) {
    rig_ = *std::move(rig);
  }
}

void FlightRecording::expect_images() const {
  for (const std::string& pair : pair_names_) {
    for (const char* const side : {"left", "right"}) {
      for (int frame = 0; frame < frame_count(); ++frame) {
        if (!fs::exists(image_file(pair, side, frame))) {
          throw input_error(image_file(pair, side, frame),
                            "is missing: frame " + std::to_string(frame) + " of " +
                                std::to_string(frame_count()) + " that frames.csv lists");
        }
      }
    }
  }
}

Timestamp FlightRecording::stamp(int frame) const {
  return stamps_.at(static_cast<std::size_t>(frame));
}

Pose FlightRecording::T_map_body(int frame) const {
  return poses_.at(static_cast<std::size_t>(frame));
}

FrameSet FlightRecording::read(int frame) const {
  FrameSet frames{.stamp = stamp(frame), .pairs = {}};
  for (std::size_t i = 0; i < rig_.pairs.size(); ++i) {
    const StereoPair& pair = rig_.pairs[i];
    frames.pairs.push_back(
        {read_image_of_size(image_file(pair_names_[i], "left", frame), left_image_size_px(pair)),
         read_image_of_size(image_file(pair_names_[i], "right", frame),
                            right_image_size_px(pair))});
  }
  return frames;
}

std::optional<LaserScan> FlightRecording::read_scan(int frame) const {
  const fs::path file = folder_ / "laser" / frame_file_name(frame, ".bin");
  if (!T_body_laser_ || !fs::exists(file)) {
    return std::nullopt;
  }
  return fs::file_size(file) == 0 ? LaserScan{} : read_velodyne(file);
}

Pose FlightRecording::T_body_laser() const {
  if (!T_body_laser_) {
    throw input_error(folder_ / kFlightFile, "laser: this key is missing; there is no scanner");
  }
  return *T_body_laser_;
}

TruthCamera FlightRecording::truth_camera() const {
  const auto found = std::ranges::find_if(rig_.pairs, [](const StereoPair& pair) {
    return std::holds_alternative<PinholePair>(pair.model);
  });
  if (found == rig_.pairs.end()) {
    throw input_error(folder_ / "rig.yaml",
                      "expected a pinhole pair, in whose image the laser's ground truth counts");
  }
  const PinholePair& model = std::get<PinholePair>(found->model);
  return {model.focal_px,
          model.principal_u_px,
          model.principal_v_px,
          found->image_size_px,
          found->T_body_camera.inverse() * T_body_laser()};
}

std::vector<OrientedBox> FlightRecording::boxes_in_body(int frame) const {
  const Pose T_body_map = true_pose(frame).value_or(T_map_body(frame)).inverse();
  std::vector<OrientedBox> boxes;
  for (const SceneObject& object : objects(frame)) {
    boxes.push_back(box_of(object, T_body_map * object.T_map_object));
  }
  return boxes;
}

std::span<const SceneObject> FlightRecording::objects(int frame) const {
  if (objects_.empty()) {
    return {};
  }
  return objects_.at(static_cast<std::size_t>(frame));
}

std::optional<Pose> FlightRecording::true_pose(int frame) const {
  return true_poses_.empty() ? std::nullopt
                             : std::optional(true_poses_.at(static_cast<std::size_t>(frame)));
}

std::optional<double> FlightRecording::sonar_m(int frame) const {
  return sonar_m_.empty() ? std::nullopt : sonar_m_.at(static_cast<std::size_t>(frame));
}

cv::Mat1f FlightRecording::true_disparity_px(int frame, int pair) const {
  const fs::path file = truth_folder(pair) / "disparity" / frame_file_name(frame, ".png");
  return fs::exists(file) ? disparities_of(file) : cv::Mat1f();
}

cv::Mat1f FlightRecording::true_range_m(int frame, int pair) const {
  const fs::path file = truth_folder(pair) / "range" / frame_file_name(frame, ".pfm");
  return fs::exists(file) ? read_pfm(file) : cv::Mat1f();
}

fs::path FlightRecording::image_file(const std::string& pair, const char* side, int frame) const {
  return folder_ / "images" / pair / side / frame_file_name(frame, ".png");
}

fs::path FlightRecording::truth_folder(int pair) const {
  return folder_ / "truth" / pair_names_.at(static_cast<std::size_t>(pair));
}

}  // namespace skyhalo
