#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/calibration/kitti_calibration.hpp"
#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/dataset/laser_source.hpp"

namespace skyhalo {

/// True when the folder looks like KITTI's tracking benchmark: `image_02`, `image_03`, `oxts` and
/// `calib` in it, or in its `training`.
[[nodiscard]] bool is_kitti_tracking(const std::filesystem::path& folder);

/// The sequences in such a folder, by its calibration files `calib/NNNN.txt`, in order. Throws
/// `Error` (input) naming the folder when it is none.
[[nodiscard]] std::vector<std::string> kitti_tracking_sequences(
    const std::filesystem::path& folder);

/// A sequence of KITTI's tracking benchmark, colour cameras: `image_02/NNNN/NNNNNN.png` (left),
/// `image_03` (right), `velodyne/NNNN/NNNNNN.bin`, `oxts/NNNN.txt` with a line per frame, and
/// `calib/NNNN.txt`. There are no time stamps: frame k is at k times 0.1 s after 1970. The map
/// frame is the body's (INS) at frame 0.
class KittiTrackingSequence final : public FrameSource, public LaserSource {
 public:
  /// `folder` holds the layout, or `training` with it; `sequence` has four digits. Reads
  /// calibration and poses, and sees that no image of the sequence is missing. Throws `Error`
  /// (input) naming file and line. With a `rig`, its one pair takes the place of the calibration's
  /// for the images, and its body that of the INS.
  KittiTrackingSequence(const std::filesystem::path& folder,
                        std::string sequence,
                        std::optional<KittiRig> rig = std::nullopt);

  /// The sequence's number.
  [[nodiscard]] std::string name() const override { return sequence_; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(poses_.size()); }

  [[nodiscard]] Timestamp stamp(int frame) const override;
  [[nodiscard]] Pose T_map_body(int frame) const override;
  [[nodiscard]] FrameSet read(int frame) const override;

  [[nodiscard]] std::optional<LaserScan> read_scan(int frame) const override;

  [[nodiscard]] Pose T_body_laser() const override { return calibration_.T_body_laser; }

  [[nodiscard]] TruthCamera truth_camera() const override;

  [[nodiscard]] Pose T_annotation_laser() const override { return calibration_.T_reference_laser; }

  /// The sequence's labels, `label_02/NNNN.txt`; the file need not be there.
  [[nodiscard]] std::filesystem::path label_file() const;

 private:
  [[nodiscard]] std::filesystem::path frame_file(const char* sensor,
                                                 int frame,
                                                 const char* ending) const;
  void expect_images() const;

  std::filesystem::path folder_;  // with image_02 in it
  std::string sequence_;
  KittiCalibration calibration_;
  StereoRig rig_;
  cv::Size image_size_px_;
  std::vector<Pose> poses_;  // T_map_body
};

}  // namespace skyhalo
