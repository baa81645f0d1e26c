#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/dataset/scene_object.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "skyhalo/io/staged_folder.hpp"

namespace skyhalo {

/// What a recording says of itself, whatever its frames.
struct FlightDescription {
  std::string name;                           ///< for reports; not empty
  std::map<std::string, std::string> source;  ///< where it comes from, for instance scene and seed
  RigDescription rig;                         ///< any number of pairs, raw or rectified
  std::optional<Pose> T_body_laser;           ///< set when there is a laser scanner
  bool has_sonar = false;                     ///< whether there is a range finder
  bool has_objects = false;                   ///< whether it is known what moves, be it nothing
};

/// What a pair should have found; an image that is empty is not recorded.
struct PairTruth {
  cv::Mat1f disparity_px;  ///< at the resolution that is matched, right camera; NaN: none
  cv::Mat1f range_m;       ///< from the right camera along the ray; NaN: none
};

/// What was recorded at one moment.
struct FlightFrame {
  FrameSet images;                     ///< stamp, and the images of all pairs
  Pose T_map_body = Pose::Identity();  ///< as measured
  std::optional<Pose> true_pose;       ///< `T_map_body` as it was; in all frames or in none
  std::optional<LaserReturns> scan;    ///< only with a laser scanner
  std::optional<double> sonar_m;       ///< only with a range finder; none: no echo
  std::vector<SceneObject> objects{};  ///< only if known; upright: only their yaw is kept
  std::vector<PairTruth> truth{};      ///< empty, or one per pair
};

/// Writes a recording in skyhalo's own layout, which `FlightRecording` reads; docs/recordings.md
/// describes it. Numbers are written so that they read back to the last bit, disparities excepted
/// (1/256 px).
///
/// The files are written to a hidden folder beside `folder`, which is renamed by `finish()`;
/// without it nothing stays. Used by one thread at a time.
class FlightRecordingWriter {
 public:
  /// Throws `Error` (input) for a description that cannot be used, and `Error` (failure) when the
  /// folder cannot be made or holds something already.
  FlightRecordingWriter(const std::filesystem::path& folder, FlightDescription description);

  /// Adds the next frame. Throws `Error` (input) naming the frame for stamps that do not grow,
  /// images, scans, poses, objects or truth that do not fit the description; `Error` (failure) when
  /// it cannot be written.
  void add(const FlightFrame& frame);

  /// Where to write a further file, for instance `truth/exact.skymap`, that appears with the rest.
  [[nodiscard]] std::filesystem::path file(const std::filesystem::path& relative) const {
    return staged_.file(relative);
  }

  /// Makes the recording appear. Throws `Error` (input) without a frame and `Error` (failure) when
  /// it cannot be written or was finished before.
  void finish();

 private:
  void check_fits(const FlightFrame& frame) const;
  void write_pairs(const FlightFrame& frame) const;
  void add_rows(const FlightFrame& frame);

  StagedFolder staged_;
  FlightDescription description_;
  StereoRig rig_;
  int frame_count_ = 0;
  std::optional<Timestamp> last_stamp_;
  bool has_true_poses_ = false;
  std::string frames_csv_;
  std::string poses_;
  std::string true_poses_;
  std::string sonar_csv_;
  std::string objects_csv_;
};

}  // namespace skyhalo
