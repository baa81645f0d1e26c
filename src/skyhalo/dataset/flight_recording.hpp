#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/dataset/laser_source.hpp"
#include "skyhalo/dataset/scene_object.hpp"

namespace skyhalo {

/// True when the folder holds a recording in skyhalo's own layout: a `flight.json`.
[[nodiscard]] bool is_flight_recording(const std::filesystem::path& folder);

/// A recording in skyhalo's own layout, which `FlightRecordingWriter` writes; docs/recordings.md
/// describes it. Everything but images and poses may be missing. The map frame is the recording's
/// own: poses are given as they were written. The annotations' frame is the body's.
class FlightRecording final : public FrameSource, public LaserSource {
 public:
  /// Reads everything but images and scans, and sees that no image is missing. Throws `Error`
  /// (input) naming file and line or key. With a `rig`, which describes the same number of pairs in
  /// the same body, its pairs take the place of the recording's for the images.
  explicit FlightRecording(const std::filesystem::path& folder,
                           std::optional<StereoRig> rig = std::nullopt);

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(stamps_.size()); }

  [[nodiscard]] Timestamp stamp(int frame) const override;

  /// The pose as it was measured.
  [[nodiscard]] Pose T_map_body(int frame) const override;

  [[nodiscard]] FrameSet read(int frame) const override;

  [[nodiscard]] bool has_laser() const noexcept { return T_body_laser_.has_value(); }

  /// None in a recording without laser scanner.
  [[nodiscard]] std::optional<LaserScan> read_scan(int frame) const override;

  /// Throws `Error` (input) when there is no laser scanner.
  [[nodiscard]] Pose T_body_laser() const override;

  /// The first pinhole pair's rectified right camera at full resolution. Throws `Error` (input)
  /// when there is no such pair or no laser scanner.
  [[nodiscard]] TruthCamera truth_camera() const override;

  [[nodiscard]] Pose T_annotation_laser() const override { return T_body_laser(); }

  /// The boxes (m, body frame) of the objects at a frame: from the true pose where it is known.
  [[nodiscard]] std::vector<OrientedBox> boxes_in_body(int frame) const;

  /// The objects at a frame; none where they were not recorded.
  [[nodiscard]] std::span<const SceneObject> objects(int frame) const;

  /// Where the body really was (`T_map_body`); none where only measured poses were recorded.
  [[nodiscard]] std::optional<Pose> true_pose(int frame) const;

  [[nodiscard]] bool has_sonar() const noexcept { return !sonar_m_.empty(); }

  /// Whether it is known what moves, be it nothing.
  [[nodiscard]] bool has_objects() const noexcept { return !objects_.empty(); }

  /// The range finder's range; none without echo or without range finder.
  [[nodiscard]] std::optional<double> sonar_m(int frame) const;

  /// The disparities that a pair should have found, right camera, at the resolution that is matched
  /// (1/256 px; NaN: none); empty where they were not recorded.
  [[nodiscard]] cv::Mat1f true_disparity_px(int frame, int pair) const;

  /// The ranges from a pair's right camera (m; NaN: none); empty where they were not recorded.
  [[nodiscard]] cv::Mat1f true_range_m(int frame, int pair) const;

  /// Where the recording comes from, in free words.
  [[nodiscard]] const std::map<std::string, std::string>& source() const noexcept {
    return source_;
  }

 private:
  void use_rig(std::optional<StereoRig> rig);
  void expect_images() const;
  [[nodiscard]] std::filesystem::path image_file(const std::string& pair,
                                                 const char* side,
                                                 int frame) const;
  [[nodiscard]] std::filesystem::path truth_folder(int pair) const;

  std::filesystem::path folder_;
  std::string name_;
  std::map<std::string, std::string> source_;
  StereoRig rig_;
  std::vector<std::string> pair_names_;  // as the recording's own rig has them
  std::optional<Pose> T_body_laser_;
  std::vector<Timestamp> stamps_;
  std::vector<Pose> poses_;                        // T_map_body
  std::vector<Pose> true_poses_;                   // empty: not recorded
  std::vector<std::optional<double>> sonar_m_;     // empty: not recorded
  std::vector<std::vector<SceneObject>> objects_;  // empty: not recorded
};

}  // namespace skyhalo
