#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

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

/// Reads an `oxts/NNNN.txt` of KITTI's tracking benchmark: such a line per frame. Throws as
/// `read_oxts` does, and for a file without lines.
[[nodiscard]] std::vector<InsReading> read_oxts_table(const std::filesystem::path& file);

/// The body in a local plane (x east, y north, z up): Mercator projection scaled for the latitude
/// of the first reading (KITTI development kit), `R = Rz(yaw) Ry(pitch) Rx(roll)`. Positions are
/// large numbers; poses relative to the first one are what is meant to be used.
[[nodiscard]] Pose T_enu_body(const InsReading& reading, double first_latitude_deg);

/// The reading that `T_enu_body` gives this pose for. Where the body points straight up or down,
/// its roll is taken for 0.
[[nodiscard]] InsReading ins_reading(const Pose& T_enu_body, double first_latitude_deg);

/// The poses of readings in the frame of the first one's body.
[[nodiscard]] std::vector<Pose> poses_of(std::span<const InsReading> readings);

/// The lines of an `oxts/NNNN.txt` for poses (map: z up) that are 0.1 s apart: the first one stands
/// at 49 degrees north, 8.4 degrees east, 116 m, and the map's x points east. Velocities, turn
/// rates and accelerations (with gravity: a body at rest has 9.81 m/s^2 upwards) are differences of
/// poses.
[[nodiscard]] std::string oxts_text(std::span<const Pose> poses);

}  // namespace skyhalo
