#include "skyhalo/dataset/kitti_tracking.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/dataset/kitti_frames.hpp"
#include "skyhalo/dataset/kitti_oxts.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/io/image_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLeft = "image_02";
constexpr const char* kRight = "image_03";

bool has_layout(const fs::path& folder) {
  std::error_code ignored;
  return std::ranges::all_of(std::array{kLeft, kRight, "oxts", "calib"}, [&](const char* name) {
    return fs::is_directory(folder / name, ignored);
  });
}

fs::path layout_folder(const fs::path& folder) {
  for (const fs::path& candidate : {folder, folder / "training"}) {
    if (has_layout(candidate)) {
      return candidate;
    }
  }
  throw input_error(folder,
                    "is no folder of KITTI's tracking benchmark; expected image_02, image_03, oxts "
                    "and calib in it or in its training/");
}

bool is_sequence(const std::string& name) {
  return name.size() == 4 && name.find_first_not_of("0123456789") == std::string::npos;
}

std::string checked_sequence(const fs::path& folder, std::string sequence) {
  if (!is_sequence(sequence)) {
    throw input_error(folder, "expected a sequence of four digits, found '" + sequence + "'");
  }
  return sequence;
}

}  // namespace

bool is_kitti_tracking(const fs::path& folder) {
  return has_layout(folder) || has_layout(folder / "training");
}

std::vector<std::string> kitti_tracking_sequences(const fs::path& folder) {
  std::vector<std::string> sequences;
  for (const fs::directory_entry& entry : fs::directory_iterator(layout_folder(folder) / "calib")) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".txt" && is_sequence(stem)) {
      sequences.push_back(stem);
    }
  }
  std::ranges::sort(sequences);
  return sequences;
}

KittiTrackingSequence::KittiTrackingSequence(const fs::path& folder,
                                             std::string sequence,
                                             std::optional<KittiRig> rig)
    : folder_(layout_folder(folder)),
      sequence_(checked_sequence(folder_, std::move(sequence))),
      calibration_(read_kitti_tracking_calibration(folder_ / "calib" / (sequence_ + ".txt"))),
      poses_(poses_of(read_oxts_table(folder_ / "oxts" / (sequence_ + ".txt")))) {
  expect_images();
  image_size_px_ = read_image(frame_file(kRight, 0, ".png")).size();
  if (!rig) {
    rig_ = kitti_stereo_rig(calibration_, image_size_px_);
    return;
  }
  if (rig->rig.pairs.size() != 1) {
    throw input_error(folder_, "expected a rig of one pair, for KITTI's two colour cameras");
  }
  rig_ = std::move(rig->rig);
  move_body(rig->T_body_imu, calibration_, poses_);
}

void KittiTrackingSequence::expect_images() const {
  for (const char* const camera : {kLeft, kRight}) {
    for (int frame = 0; frame < frame_count(); ++frame) {
      if (!fs::exists(frame_file(camera, frame, ".png"))) {
        throw input_error(frame_file(camera, frame, ".png"),
                          "is missing: frame " + std::to_string(frame) + " of " +
                              std::to_string(frame_count()) + " that oxts/" + sequence_ +
                              ".txt lists");
      }
    }
    if (fs::exists(frame_file(camera, frame_count(), ".png"))) {
      throw input_error(folder_ / "oxts" / (sequence_ + ".txt"),
                        "has lines for " + std::to_string(frame_count()) +
                            " frames, but there are more images in " + camera);
    }
  }
}

Timestamp KittiTrackingSequence::stamp(int frame) const {
  constexpr std::chrono::milliseconds kStep{100};
  (void)poses_.at(static_cast<std::size_t>(frame));
  return Timestamp(kStep * frame);
}

Pose KittiTrackingSequence::T_map_body(int frame) const {
  return poses_.at(static_cast<std::size_t>(frame));
}

FrameSet KittiTrackingSequence::read(int frame) const {
  const StereoPair& pair = rig_.pairs.front();
  return {.stamp = stamp(frame),
          .pairs = {
              {read_image_of_size(frame_file(kLeft, frame, ".png"), left_image_size_px(pair)),
               read_image_of_size(frame_file(kRight, frame, ".png"), right_image_size_px(pair))}}};
}

std::optional<LaserScan> KittiTrackingSequence::read_scan(int frame) const {
  const fs::path file = frame_file("velodyne", frame, ".bin");
  if (!fs::exists(file)) {
    return std::nullopt;
  }
  return read_velodyne(file);
}

TruthCamera KittiTrackingSequence::truth_camera() const {
  return kitti_truth_camera(calibration_, image_size_px_);
}

fs::path KittiTrackingSequence::label_file() const {
  return folder_ / "label_02" / (sequence_ + ".txt");
}

fs::path KittiTrackingSequence::frame_file(const char* sensor,
                                           int frame,
                                           const char* ending) const {
  return folder_ / sensor / sequence_ / frame_file_name(frame, ending);
}

}  // namespace skyhalo
