#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace skyhalo {

/// The calibration files of other programs that can be imported.
enum class CalibrationFormat {
  kAuto,           ///< recognised by what the files hold
  kKalibr,         ///< `camchain.yaml`
  kEuroc,          ///< one `sensor.yaml` for each camera, or the folder of them
  kOpencv,         ///< stereo calibration of `cv::FileStorage`, one file or two
  kRos,            ///< two `camera_info` files, left and right
  kBasalt,         ///< JSON of Basalt or visnav
  kKittiRaw,       ///< day folder, or its `calib_cam_to_cam.txt`
  kKittiTracking,  ///< one file of the tracking or object benchmark
};

/// A word for the format: `auto`, `kalibr`, `euroc`, `opencv`, `ros`, `basalt`, `kitti_raw` or
/// `kitti_tracking`.
[[nodiscard]] std::string_view name_of(CalibrationFormat format) noexcept;

/// The format of these files, by what they hold and not by their names. Throws `Error` (input) when
/// none are given, one is missing, empty or no text, and, with the formats that are known, when
/// nothing fits.
[[nodiscard]] CalibrationFormat recognise_format(const std::vector<std::filesystem::path>& files);

}  // namespace skyhalo
