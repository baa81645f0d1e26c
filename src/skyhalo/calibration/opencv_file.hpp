#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// The two cameras of an OpenCV stereo calibration (`cv::FileStorage`: YAML, XML or JSON) in one
/// file or in two, intrinsics and extrinsics. Camera 1 is left and the reference.
///
/// - camera matrix: `M1`, `K1`, `cameraMatrix1`, `camera_matrix_1`, `cameraMatrixL`,
///   `cameraMatrixLeft`, `camera_matrix_left`, `left_camera_matrix`, `K_left`, `KL`, and so on for
///   2;
/// - distortion: `D1`, `distCoeffs1`, `dist_coeffs_1`, `distCoeffsL`, `distCoeffsLeft`,
///   `dist_coeffs_left`, `distortion_left`, `left_distortion`, `D_left`, `DL`, and so on;
/// - `R` (3x3) and `T` (3; the unit of the baseline is taken for m) with X2 = R X1 + T;
/// - size: `imageSize`, `image_size`, or `image_width` and `image_height`; else `size_px`.
///
/// The lens is radial-tangential with 4, 5 or 8 coefficients. Four alone do not tell it from the
/// fisheye model: a key must say so, `distortion_model` or `camera_model` with `equidistant` or
/// `fisheye`, or `fisheye_model: 1`, or `fisheye` must ask for it; else a warning says what they
/// were taken for. The omnidirectional model (`xi`, `xi1`) is refused.
///
/// Throws `Error` (input) naming file and key for what is missing, malformed or not supported, and
/// when `fisheye` is asked for and the files name another model.
[[nodiscard]] ImportedCameras read_opencv_stereo(const std::vector<std::filesystem::path>& files,
                                                 std::optional<cv::Size> size_px,
                                                 bool fisheye = false);

/// What a camera matrix of such a file may be called, left (0) or right (1).
[[nodiscard]] std::span<const std::string_view> opencv_camera_matrix_keys(int camera) noexcept;

}  // namespace skyhalo
