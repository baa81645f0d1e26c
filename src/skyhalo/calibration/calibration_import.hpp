#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/calibration/calibration_format.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// How calibration files are imported.
struct ImportOptions {
  CalibrationFormat format = CalibrationFormat::kAuto;
  /// KITTI's files say which way the cameras look; there `facing` counts only without the IMU, and
  /// a warning says so.
  Mounting mounting = {};
  std::optional<cv::Size> size_px = {};  ///< of the images, for files without it; 1...16384
  std::string name = {};                 ///< of the rig; empty for the format's name
  /// Take the distortion coefficients of OpenCV's files for those of `cv::fisheye`
  /// (Kannala-Brandt), of which there must be exactly 4. Other files name their lens model.
  bool opencv_fisheye = false;
};

/// What the import of calibration files gives.
struct ImportResult {
  RigDescription rig;
  CalibrationFormat format = CalibrationFormat::kAuto;  ///< what the files were taken for
  std::vector<std::string> warnings;  ///< what looks wrong in the files but can be used
};

/// Imports the calibration files of another program as a rig: one file, those of the cameras in
/// order (left, right, ...), or a folder. KITTI raw gives its grey pair.
///
/// Throws `Error` (input) with file, line and key for what cannot be used, when the number of files
/// does not fit the format, when `size_px` is out of range and when the files' image size is not
/// `size_px`.
[[nodiscard]] ImportResult import_calibration(const std::vector<std::filesystem::path>& files,
                                              const ImportOptions& options);

}  // namespace skyhalo
