#pragma once

#include <filesystem>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// What KITTI's INS says of the position and attitude of the body (x forward, y left, z up).
struct InsReading {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;  ///< 0 is east, counter-clockwise
};

/// Reads the first line of a KITTI raw `oxts/data/*.txt` file (30 numbers). Throws `Error` (input)
/// with file and line when it does not hold 30 finite numbers or a latitude is beyond +-90 degrees.
[[nodiscard]] InsReading read_oxts(const std::filesystem::path& file);

/// The body in a local plane (x east, y north, z up): Mercator projection scaled for the latitude
/// of the first reading (KITTI development kit), `R = Rz(yaw) Ry(pitch) Rx(roll)`. Positions are
/// large numbers; poses relative to the first one are what is meant to be used.
[[nodiscard]] Pose T_enu_body(const InsReading& reading, double first_latitude_deg);

}  // namespace skyhalo
