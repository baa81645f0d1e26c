#pragma once

#include <Eigen/Core>
#include <vector>

#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo {

/// What a simulated vehicle can do.
struct FlightLimits {
  double speed_mps = 4.0;          ///< 0.05 to 50
  double acceleration_mps2 = 3.0;  ///< along and across the path together; 0.05 to 9.5, below g
  double yaw_rate_radps = 1.5;     ///< 0.05 to 10
};

/// Throws `Error` (input) that names the limit that is out of its range.
void check_limits(const FlightLimits& limits);

/// A flight along waypoints (m, map) from rest to rest, sampled at 100 Hz. The path is a
/// centripetal Catmull-Rom spline; a closed one comes back to the first waypoint. It is flown as
/// fast as the limits allow, then smoothed in time with a Gaussian of 0.1 s, which makes the
/// acceleration continuous, keeps the limits and passes each waypoint within
/// 0.005 s^2 * `acceleration_mps2` (1.5 cm at 3 m/s^2). Where the path turns back on itself the
/// flight stops. The body's z is along the thrust, x points where the flight goes, as far as the
/// limit of the yaw's rate allows; below 0.2 m/s across the ground the yaw stays.
///
/// Consecutive waypoints less than 1 mm apart count once. Throws `Error` (input) when fewer than
/// two waypoints are left, one is not finite or further out than 1e6 m, the path is longer
/// than 20 km, the flight longer than an hour, or a limit is out of its range.
[[nodiscard]] Trajectory fly_waypoints(const std::vector<Eigen::Vector3d>& waypoints_m,
                                       const FlightLimits& limits,
                                       bool is_closed);

}  // namespace skyhalo
