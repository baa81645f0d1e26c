#pragma once

#include <filesystem>

#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {

/// The cameras of a Basalt calibration (JSON), in either layout: Basalt's own `value0.T_imu_cam`,
/// `value0.intrinsics` and `value0.resolution`, or visnav's `value0."cam.T_i_c"` and
/// `value0."cam.intrinsics"`. The poses take a camera to the IMU (m, unit quaternions), the
/// reference. Lenses: `ds`, `eucm`, `kb4`, `pinhole` and `pinhole-radtan8` (its `rpmax` is left
/// out).
///
/// Throws `Error` (input) with file and JSON path (`value0.intrinsics[0].intrinsics.fx`) for what
/// is missing, malformed or not supported.
[[nodiscard]] ImportedCameras read_basalt(const std::filesystem::path& file);

}  // namespace skyhalo
