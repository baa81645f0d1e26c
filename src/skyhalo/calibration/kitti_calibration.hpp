#pragma once

#include <filesystem>

#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Which two of KITTI's four cameras form the pair.
enum class KittiPair {
  kGrey,    ///< 00 (left) and 01 (right)
  kColour,  ///< 02 (left) and 03 (right)
};

/// Number of the left camera of a pair: 0 or 2; the right one's is one more.
[[nodiscard]] constexpr int left_camera(KittiPair pair) noexcept {
  return pair == KittiPair::kGrey ? 0 : 2;
}

/// KITTI's calibration of one rectified pair. Body is the INS: x forward, y left, z up. `reference`
/// is the rectified camera 00, the frame of the annotations.
struct KittiCalibration {
  PinholePair pair;
  Pose T_body_laser = Pose::Identity();
  Pose T_reference_laser = Pose::Identity();
  Pose T_left_reference = Pose::Identity();
  Pose T_right_reference = Pose::Identity();

  /// The rectified right camera to the body.
  [[nodiscard]] Pose T_body_right() const {
    return T_body_laser * (T_right_reference * T_reference_laser).inverse();
  }
};

/// Reads `calib_cam_to_cam.txt`, `calib_velo_to_cam.txt` and `calib_imu_to_velo.txt` of a KITTI raw
/// day folder. Throws `Error` (input) with file, line and key when a key is missing or malformed, a
/// rotation is not one, or the pair has no positive focal length and baseline.
[[nodiscard]] KittiCalibration read_kitti_raw_calibration(const std::filesystem::path& day_folder,
                                                          KittiPair pair);

/// Reads the colour pair (`P2`, `P3`) of a calibration file of KITTI's tracking or object
/// benchmark, with `R_rect` or `R0_rect`, `Tr_velo_cam` or `Tr_velo_to_cam`, `Tr_imu_velo` or
/// `Tr_imu_to_velo`, with or without colons. Throws as `read_kitti_raw_calibration` does.
[[nodiscard]] KittiCalibration read_kitti_tracking_calibration(const std::filesystem::path& file);

}  // namespace skyhalo
