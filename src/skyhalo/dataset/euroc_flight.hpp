#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/dataset/frame_source.hpp"

namespace skyhalo {

/// True when the folder looks like a EuRoC (ASL) flight: a `mav0` folder with `cam0` and `cam1`, or
/// the folder it lies in.
[[nodiscard]] bool is_euroc_flight(const std::filesystem::path& folder);

/// Image pairs of a flight that are left out, and why.
struct DroppedFrames {
  int unpaired = 0;       ///< time stamps that only one camera lists
  int without_image = 0;  ///< listed by both cameras, but an image file is missing
  int without_pose = 0;   ///< outside the ground truth's span or in a gap of it
};

/// A flight in EuRoC's (ASL) layout: `mav0/cam0` is the left camera, `mav0/cam1` the right one,
/// each with `data.csv` and `data/`; poses come from `mav0/state_groundtruth_estimate0`, where it
/// is there. An image that is listed as `.png` may be a `.jpg` file, and the other way round.
///
/// The map frame has its origin where the body was at the first frame and its z upwards like the
/// ground truth's world; its x is the direction in which the body headed then, without its pitch
/// and roll (where its x axis was upright: the direction a quarter turn to the right of its y
/// axis).
class EurocFlight final : public FrameSource {
 public:
  /// Reads time stamps and poses and looks for the images. `rig` has one pair, cam0 and cam1;
  /// `T_body_imu` places the IMU, whose poses the ground truth gives. Throws `Error` (input) naming
  /// file and line, also when no frame remains.
  EurocFlight(const std::filesystem::path& folder,
              StereoRig rig,
              const Pose& T_body_imu = Pose::Identity());

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(frames_.size()); }

  [[nodiscard]] Timestamp stamp(int frame) const override;

  /// Throws `Error` (input) when the flight has no ground truth.
  [[nodiscard]] Pose T_map_body(int frame) const override;

  /// Throws `Error` (input) naming the file when an image cannot be read or has another size than
  /// the rig says.
  [[nodiscard]] FrameSet read(int frame) const override;

  /// Whether the flight comes with ground truth.
  [[nodiscard]] bool has_poses() const noexcept { return !poses_.empty(); }

  [[nodiscard]] const DroppedFrames& dropped() const noexcept { return dropped_; }

 private:
  struct Frame {
    Timestamp stamp;
    std::filesystem::path left;
    std::filesystem::path right;
  };

  void find_frames();
  void find_poses(const Pose& T_body_imu);

  std::filesystem::path folder_;  // mav0
  std::string name_;
  StereoRig rig_;
  std::vector<Frame> frames_;
  std::vector<Pose> poses_;  // T_map_body of each frame; empty without ground truth
  DroppedFrames dropped_;
};

}  // namespace skyhalo
