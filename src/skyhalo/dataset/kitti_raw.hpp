#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/calibration/kitti_calibration.hpp"
#include "skyhalo/config/config.hpp"
#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/dataset/laser_source.hpp"

namespace skyhalo {

/// True when the folder looks like a KITTI raw drive (it has `image_00` or `image_02`, and `oxts`).
[[nodiscard]] bool is_kitti_raw_drive(const std::filesystem::path& folder);

/// Other cameras' description for a drive, with a body of its own.
struct KittiRig {
  StereoRig rig;                       ///< one pair
  Pose T_body_imu = Pose::Identity();  ///< the INS in that body
};

/// A drive of the KITTI raw data, synchronised and rectified: `image_0X/data/NNNNNNNNNN.png`,
/// `oxts/data`, `velodyne_points/data`, with the day's calibration files in the parent folder. The
/// map frame is the body's (INS) at frame 0.
class KittiRawDrive final : public FrameSource, public LaserSource {
 public:
  /// Reads calibration, time stamps and poses, and sees that no image of the drive is missing.
  /// Throws `Error` (input) naming file and line.
  /// With a `rig`, its one pair takes the place of the calibration's for the images, and its body
  /// that of the INS.
  KittiRawDrive(const std::filesystem::path& folder,
                const DatasetConfig& config,
                std::optional<KittiRig> rig = std::nullopt);

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(stamps_.size()); }

  [[nodiscard]] Timestamp stamp(int frame) const override;
  [[nodiscard]] Pose T_map_body(int frame) const override;
  [[nodiscard]] FrameSet read(int frame) const override;

  [[nodiscard]] std::optional<LaserScan> read_scan(int frame) const override;

  [[nodiscard]] Pose T_body_laser() const override { return calibration_.T_body_laser; }

  [[nodiscard]] TruthCamera truth_camera() const override;

  [[nodiscard]] Pose T_annotation_laser() const override { return calibration_.T_reference_laser; }

 private:
  void use_rig(KittiRig rig);
  [[nodiscard]] std::filesystem::path image_file(int camera, int frame) const;

  std::filesystem::path folder_;
  std::string name_;
  KittiPair cameras_;
  KittiCalibration calibration_;
  StereoRig rig_;
  std::vector<Timestamp> stamps_;
  std::vector<Pose> poses_;  // T_map_body
};

/// Reads a KITTI `timestamps.txt`: a line `YYYY-MM-DD HH:MM:SS.nnnnnnnnn` per frame, taken as UTC.
/// Throws `Error` (input) with file and line.
[[nodiscard]] std::vector<Timestamp> read_kitti_timestamps(const std::filesystem::path& file);

}  // namespace skyhalo
