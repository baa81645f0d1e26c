#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "skyhalo/sim/trajectory.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"

namespace skyhalo {

/// The kinds of flights that have a name.
enum class FlightKind {
  kWaypoints,   ///< `route`: along waypoints within the plan's limits
  kHover,       ///< `hover`: about a point
  kOrbit,       ///< `orbit`: a circle
  kAggressive,  ///< `aggressive`: along waypoints within `aggressive_limits`
};

/// Where the body's x axis points on a circle.
enum class OrbitYaw { kAlongMotion, kTowardsCentre };

/// A hover that is never quite still: the position wanders and the body sways, both by slow
/// oscillations (0.05 to 0.6 Hz) that the seed chooses.
struct HoverSettings {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< the middle of the wander, map
  double yaw_rad = 0.0;                                  ///< the middle yaw
  double wander_m = 0.04;                                ///< greatest distance; 0 to 1
  double sway_rad = 0.026;                               ///< greatest tilt and yaw error; 0 to 0.5
  double duration_s = 20.0;                              ///< 0.1 to 3600
  std::uint64_t seed = 1;
};

/// A horizontal circle at a constant speed, that of the first and the last moment too. It begins
/// at centre + (radius, 0, 0).
struct OrbitSettings {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< map
  double radius_m = 5.0;                               ///< 0.1 to 10000
  double speed_mps = 2.0;                              ///< 0.05 to 50; speed^2 / radius up to 9.5
  double turns = 1.0;                                  ///< 0.001 to 1e6
  OrbitYaw yaw = OrbitYaw::kAlongMotion;
  bool is_clockwise = false;  ///< seen from above
};

/// A flight to be simulated; each kind reads its own fields.
struct FlightPlan {
  std::vector<Eigen::Vector3d> waypoints_m;  ///< map; `kWaypoints` and `kAggressive`
  FlightLimits limits{};                     ///< `kWaypoints`
  HoverSettings hover{};
  OrbitSettings orbit{};
  FlightKind kind = FlightKind::kWaypoints;
  bool is_closed = false;  ///< back to the first waypoint; `kWaypoints` and `kAggressive`
};

/// 12 m/s, 9 m/s^2 and 3 rad/s.
[[nodiscard]] FlightLimits aggressive_limits() noexcept;

/// The kind of a name, nothing for other words.
[[nodiscard]] std::optional<FlightKind> flight_kind(std::string_view name) noexcept;

/// The motion of a hover; attitudes are the sway alone. Throws `Error` (input) when a setting is
/// out of its range.
[[nodiscard]] Trajectory fly_hover(const HoverSettings& settings);

/// The motion on a circle, banked towards its centre. Throws `Error` (input) when a setting is
/// out of its range or the flight is longer than an hour.
[[nodiscard]] Trajectory fly_orbit(const OrbitSettings& settings);

/// The motion of a plan. Throws `Error` (input) as the function of its kind does.
[[nodiscard]] Trajectory fly(const FlightPlan& plan);

}  // namespace skyhalo
