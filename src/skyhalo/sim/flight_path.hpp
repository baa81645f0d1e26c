#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace skyhalo {

/// A curve as many points close to each other, all of one length N except `lengths_m`.
struct FlightPath {
  std::vector<Eigen::Vector3d> points_m;  ///< map; no two consecutive ones are the same
  std::vector<Eigen::Vector3d> tangents;  ///< unit; zero at a corner
  std::vector<double> curvatures_per_m;   ///< 1 / radius; 0 at a corner and at the ends
  std::vector<double> lengths_m;          ///< N - 1, from each point to the next

  /// Whether the curve turns so sharply at a point that only a stop makes it flyable.
  [[nodiscard]] bool is_corner(std::size_t i) const noexcept { return tangents[i].isZero(0.0); }

  /// The point (m) at a fraction 0 to 1 of the way from point i to the next.
  [[nodiscard]] Eigen::Vector3d point_m(std::size_t i, double fraction) const noexcept;
};

/// The centripetal Catmull-Rom spline through waypoints (m), with a point every 2 cm or closer on
/// average. Open splines end straight; closed ones come back to the first waypoint. Needs two
/// waypoints, no two consecutive ones (of a closed one the last and the first, too) the same
/// or more than 1000 km apart.
[[nodiscard]] FlightPath spline_path(const std::vector<Eigen::Vector3d>& waypoints_m,
                                     bool is_closed);

/// The path along given points. Those that repeat the one before count once; needs two that
/// differ.
[[nodiscard]] FlightPath path_along(const std::vector<Eigen::Vector3d>& points_m);

}  // namespace skyhalo
