#pragma once

#include <filesystem>

#include "skyhalo/sim/trajectory.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"

namespace skyhalo {

/// How waypoints without times are flown.
struct WaypointOptions {
  FlightLimits limits{};
  bool is_closed = false;  ///< back to the first waypoint
};

/// Reads a motion from a text file, in which empty lines and those that begin with `#` are left
/// out:
/// - TUM: rows of `timestamp tx ty tz qx qy qz qw` (s, m, body to map), separated by spaces.
///   Positions by cubic Hermite, attitudes by slerp; quaternions are normalised.
/// - CSV: a header line that names columns out of `t_s,x_m,y_m,z_m,yaw_deg,roll_deg,pitch_deg`
///   in any order, then rows of numbers. x, y and z are required. Without `t_s` the rows are
///   waypoints for `fly_waypoints` with `options`, and angles are not allowed. With it they are
///   passed at their times on a cubic Hermite curve that is sampled at 100 Hz; its yaw is that of
///   the column, or of the motion within the limit of the yaw's rate; roll and pitch are those of
///   the columns (one that is missing beside the other is 0), or of the thrust. Angles are
///   R_map_body = Rz(yaw) Ry(pitch) Rx(roll): a positive pitch is nose down.
///
/// Throws `Error` (input) with file and line when the file is missing, has fewer than two rows, a
/// row has another number of columns, a number is none, not finite or absurd (1e6 m, 1e6 deg),
/// times do not increase (by 1 us), a quaternion is zero, the header is wrong, or the motion
/// takes longer than an hour; and as `fly_waypoints` does.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& file,
                                         const WaypointOptions& options = {});

}  // namespace skyhalo
