#include "skyhalo/dataset/kitti_raw.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/kitti_frames.hpp"
#include "skyhalo/dataset/kitti_oxts.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/io/image_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

std::string file_name(int frame, const char* ending) {
  std::array<char, 32> name{};
  const int length = std::snprintf(name.data(), name.size(), "%010d%s", frame, ending);
  return {name.data(), static_cast<std::size_t>(length)};
}

std::string image_folder(int camera) {
  return "image_0" + std::to_string(camera);
}

KittiPair choose_pair(const fs::path& folder, CameraChoice choice) {
  if (!fs::is_directory(folder)) {
    throw input_error(folder, "no such folder; expected a KITTI raw drive (…_drive_NNNN_sync)");
  }
  if (choice != CameraChoice::kAuto) {
    return choice == CameraChoice::kGrey ? KittiPair::kGrey : KittiPair::kColour;
  }
  return fs::is_directory(folder / image_folder(0)) ? KittiPair::kGrey : KittiPair::kColour;
}

/// Poses in the frame of the first one.
std::vector<Pose> read_poses(const fs::path& folder, std::size_t count) {
  std::vector<InsReading> readings;
  for (std::size_t frame = 0; frame < count; ++frame) {
    readings.push_back(
        read_oxts(folder / "oxts" / "data" / file_name(static_cast<int>(frame), ".txt")));
  }
  return poses_of(readings);
}

}  // namespace

bool is_kitti_raw_drive(const fs::path& folder) {
  return fs::is_directory(folder / "oxts") &&
         (fs::is_directory(folder / image_folder(0)) || fs::is_directory(folder / image_folder(2)));
}

KittiRawDrive::KittiRawDrive(const fs::path& folder,
                             const DatasetConfig& config,
                             std::optional<KittiRig> rig)
    : folder_(fs::absolute(folder).lexically_normal()),
      cameras_(choose_pair(folder_, config.cameras)) {
  if (folder_.filename().empty()) {  // the path ended in a slash
    folder_ = folder_.parent_path();
  }
  name_ = folder_.filename().string();
  const int left = left_camera(cameras_);
  if (!fs::is_directory(folder_ / image_folder(left))) {
    throw input_error(folder_ / image_folder(left),
                      "no such folder; expected the left images of a KITTI raw drive");
  }
  fs::path day = folder_.parent_path();
  if (!fs::exists(day / "calib_cam_to_cam.txt")) {  // the drive may be a link to somewhere else
    day = fs::canonical(folder_).parent_path();
  }
  calibration_ = read_kitti_raw_calibration(day, cameras_);
  stamps_ = read_kitti_timestamps(folder_ / image_folder(left) / "timestamps.txt");
  for (int frame = 0; frame < frame_count(); ++frame) {
    for (const int camera : {left, left + 1}) {
      if (!fs::exists(image_file(camera, frame))) {
        throw input_error(image_file(camera, frame),
                          "is missing: frame " + std::to_string(frame) + " of " +
                              std::to_string(frame_count()) + " that timestamps.txt lists");
      }
    }
  }
  poses_ = read_poses(folder_, stamps_.size());
  if (rig) {
    use_rig(*std::move(rig));
    return;
  }
  rig_ = kitti_stereo_rig(calibration_, read_image(image_file(left + 1, 0)).size());
}

void KittiRawDrive::use_rig(KittiRig rig) {
  if (rig.rig.pairs.size() != 1) {
    throw input_error(folder_, "expected a rig of one pair, for the two cameras of a KITTI drive");
  }
  rig_ = std::move(rig.rig);
  move_body(rig.T_body_imu, calibration_, poses_);
}

Timestamp KittiRawDrive::stamp(int frame) const {
  return stamps_.at(static_cast<std::size_t>(frame));
}

Pose KittiRawDrive::T_map_body(int frame) const {
  return poses_.at(static_cast<std::size_t>(frame));
}

FrameSet KittiRawDrive::read(int frame) const {
  FrameSet frames{.stamp = stamp(frame), .pairs = {{}}};
  StereoImages& images = frames.pairs.front();
  const int left = left_camera(cameras_);
  images.left = read_image(image_file(left, frame));
  images.right = read_image(image_file(left + 1, frame));
  const StereoPair& pair = rig_.pairs.front();
  for (const int camera : {left, left + 1}) {
    const cv::Mat& image = camera == left ? images.left : images.right;
    const cv::Size size = camera == left ? left_image_size_px(pair) : right_image_size_px(pair);
    if (image.size() != size) {
      throw input_error(image_file(camera, frame),
                        "has " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                            " pixels, expected " + std::to_string(size.width) + "x" +
                            std::to_string(size.height) + " like the first image or the rig file");
    }
  }
  return frames;
}

std::optional<LaserScan> KittiRawDrive::read_scan(int frame) const {
  const fs::path file = folder_ / "velodyne_points" / "data" / file_name(frame, ".bin");
  if (!fs::exists(file)) {
    return std::nullopt;
  }
  return read_velodyne(file);
}

TruthCamera KittiRawDrive::truth_camera() const {
  return kitti_truth_camera(calibration_, rig_.pairs.front().image_size_px);
}

fs::path KittiRawDrive::image_file(int camera, int frame) const {
  return folder_ / image_folder(camera) / "data" / file_name(frame, ".png");
}

}  // namespace skyhalo
