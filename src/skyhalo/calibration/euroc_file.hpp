#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// The cameras of EuRoC `sensor.yaml` files, one each and in this order (left, right, ...), or of
/// all `camN/sensor.yaml` in a single folder `mav0` or its parent. `T_BS` (4x4; m) takes the camera
/// to the body, which is the IMU and the reference. Lenses: `camera_model: pinhole` with
/// `radial-tangential` (4, 5 or 8 coefficients) or `equidistant` (4).
///
/// Throws `Error` (input) with file, line and key for what is missing, malformed or not supported.
[[nodiscard]] ImportedCameras read_euroc(const std::vector<std::filesystem::path>& files);

/// True for a folder that holds `cam0/sensor.yaml` or `mav0/cam0/sensor.yaml`.
[[nodiscard]] bool is_euroc_folder(const std::filesystem::path& folder);

}  // namespace skyhalo
