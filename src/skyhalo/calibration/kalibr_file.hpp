#pragma once

#include <filesystem>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// The cameras of a Kalibr `camchain.yaml`, also in the form that OpenVINS keeps: `cam0`, `cam1`,
/// ... each with `camera_model`, `intrinsics`, `distortion_model`, `distortion_coeffs`,
/// `resolution` and its place. Lenses are `pinhole` with `radtan`, `equidistant` or `none`, `ds`
/// and `eucm`.
///
/// Where all cameras have `T_cam_imu` (4x4, IMU to camera; m) or `T_imu_cam` (camera to IMU), the
/// reference is the IMU. Else it is cam0, and the cameras follow from `T_cn_cnm1`, which takes
/// points of camera n - 1 to camera n. Where both are there and contradict each other the IMU's are
/// taken, and a warning says which looks inverted.
///
/// Throws `Error` (input) with file, line and key for what is missing, malformed or of a kind that
/// is not supported.
[[nodiscard]] ImportedCameras read_kalibr(const std::filesystem::path& file);

}  // namespace skyhalo
