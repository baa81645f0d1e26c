#include "skyhalo/sim/flight_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "skyhalo/sim/hermite.hpp"

namespace skyhalo {
namespace {

constexpr double kSpacingM = 0.02;
constexpr int kFewestSteps = 64;
constexpr double kCornerCosine = 0.8;  // a turn by 37 degrees between neighbouring points

/// Waypoint i of a spline, which may be the one before the first or behind the last.
Eigen::Vector3d spline_waypoint(const std::vector<Eigen::Vector3d>& waypoints,
                                std::ptrdiff_t i,
                                bool is_closed) {
  const auto count = static_cast<std::ptrdiff_t>(waypoints.size());
  const auto at = [&](std::ptrdiff_t k) { return waypoints[static_cast<std::size_t>(k)]; };
  if (is_closed) {
    return at((i + count) % count);
  }
  if (i < 0) {
    return 2.0 * at(0) - at(1);
  }
  return i < count ? at(i) : Eigen::Vector3d(2.0 * at(count - 1) - at(count - 2));
}

/// The tangent at p1 between p0 and p2 by the parameter whose steps are the square roots of the
/// distances (Yuksel et al. 2011, centripetal).
Eigen::Vector3d centripetal_tangent(const Eigen::Vector3d& p0,
                                    const Eigen::Vector3d& p1,
                                    const Eigen::Vector3d& p2) {
  const double d0 = std::sqrt((p1 - p0).norm());
  const double d1 = std::sqrt((p2 - p1).norm());
  return (p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1;
}

/// Sets tangent and curvature at an inner point; a corner keeps zeros.
void measure_bend(FlightPath& path, std::size_t i) {
  const double before_m = path.lengths_m[i - 1];
  const double after_m = path.lengths_m[i];
  const Eigen::Vector3d in = (path.points_m[i] - path.points_m[i - 1]) / before_m;
  const Eigen::Vector3d out = (path.points_m[i + 1] - path.points_m[i]) / after_m;
  const double cosine = in.dot(out);
  if (cosine < kCornerCosine) {
    return;
  }
  path.tangents[i] = (after_m * in + before_m * out).normalized();
  path.curvatures_per_m[i] = 2.0 * std::atan2(in.cross(out).norm(), cosine) / (before_m + after_m);
}

}  // namespace

Eigen::Vector3d FlightPath::point_m(std::size_t i, double fraction) const noexcept {
  const Eigen::Vector3d along = (points_m[i + 1] - points_m[i]) / lengths_m[i];
  return hermite_value({.value_0 = points_m[i],
                        .slope_0 = is_corner(i) ? along : tangents[i],
                        .value_1 = points_m[i + 1],
                        .slope_1 = is_corner(i + 1) ? along : tangents[i + 1],
                        .interval_s = lengths_m[i]},
                       fraction);
}

FlightPath path_along(const std::vector<Eigen::Vector3d>& points_m) {
  FlightPath path;
  for (const Eigen::Vector3d& point : points_m) {
    const double length_m = path.points_m.empty() ? 1.0 : (point - path.points_m.back()).norm();
    if (!(length_m > 0.0)) {
      continue;
    }
    if (!path.points_m.empty()) {
      path.lengths_m.push_back(length_m);
    }
    path.points_m.push_back(point);
  }
  const std::size_t count = path.points_m.size();
  path.tangents.assign(count, Eigen::Vector3d::Zero());
  path.curvatures_per_m.assign(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    measure_bend(path, i);
  }
  return path;
}

FlightPath spline_path(const std::vector<Eigen::Vector3d>& waypoints_m, bool is_closed) {
  const auto count = static_cast<std::ptrdiff_t>(waypoints_m.size());
  const auto waypoint = [&](std::ptrdiff_t i) {
    return spline_waypoint(waypoints_m, i, is_closed);
  };
  std::vector<Eigen::Vector3d> points = {waypoints_m.front()};
  for (std::ptrdiff_t i = 0; i < count - (is_closed ? 0 : 1); ++i) {
    const Eigen::Vector3d start = waypoint(i);
    const Eigen::Vector3d end = waypoint(i + 1);
    const double chord_m = (end - start).norm();
    const HermiteInterval segment = {.value_0 = start,
                                     .slope_0 = centripetal_tangent(waypoint(i - 1), start, end),
                                     .value_1 = end,
                                     .slope_1 = centripetal_tangent(start, end, waypoint(i + 2)),
                                     .interval_s = std::sqrt(chord_m)};
    const int steps = std::max(kFewestSteps, static_cast<int>(std::ceil(chord_m / kSpacingM)));
    for (int step = 1; step <= steps; ++step) {
      points.push_back(hermite_value(segment, static_cast<double>(step) / steps));
    }
  }
  return path_along(points);
}

}  // namespace skyhalo
