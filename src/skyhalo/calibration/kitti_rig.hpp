#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>

#include "skyhalo/calibration/kitti_calibration.hpp"
#include "skyhalo/calibration/rig_description.hpp"

namespace skyhalo {

/// The rectified pair of a KITTI raw day folder, or of its `calib_cam_to_cam.txt`. The body is the
/// INS (x forward, y left, z up), and so is the IMU. Where neither `calib_velo_to_cam.txt` nor
/// `calib_imu_to_velo.txt` lies beside it, the right camera looks forward from the body's origin.
/// The image size is `S_rect_0X`.
///
/// Throws `Error` (input) as `read_kitti_raw_calibration` does, and when the two sizes are missing,
/// malformed or differ.
[[nodiscard]] RigDescription read_kitti_raw_rig(const std::filesystem::path& day_folder_or_file,
                                                KittiPair pair);

/// The rectified colour pair (`P2`, `P3`) of a calibration file of KITTI's tracking or object
/// benchmark, with `R_rect` or `R0_rect`, `Tr_velo_cam` or `Tr_velo_to_cam`, `Tr_imu_velo` or
/// `Tr_imu_to_velo`, with or without colons. The body is the INS, and so is the IMU.
///
/// Throws `Error` (input) with file, line and key for what is missing or malformed, and without a
/// size: these files do not say it, and it varies by sequence.
[[nodiscard]] RigDescription read_kitti_tracking_rig(const std::filesystem::path& file,
                                                     std::optional<cv::Size> size_px);

}  // namespace skyhalo
