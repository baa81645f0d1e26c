#include "skyhalo/sim/waypoint_flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/sim/flight_path.hpp"
#include "skyhalo/sim/sampled_motion.hpp"
#include "skyhalo/sim/setting_range.hpp"
#include "skyhalo/sim/speed_profile.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"

namespace skyhalo {
namespace {

constexpr double kClosestWaypointsM = 1e-3;
constexpr double kFurthestWaypointM = 1e6;
constexpr double kLongestPathM = 20'000.0;

// What the profile leaves of the limits for the points' distance.
constexpr double kSpeedShare = 0.999;
constexpr double kAccelerationShare = 0.985;

void check_waypoints(const std::vector<Eigen::Vector3d>& waypoints_m) {
  for (std::size_t i = 0; i < waypoints_m.size(); ++i) {
    const Eigen::Vector3d& waypoint = waypoints_m[i];
    if (!waypoint.allFinite() || waypoint.cwiseAbs().maxCoeff() > kFurthestWaypointM) {
      throw Error(
          ErrorKind::kInput,
          "waypoint " + std::to_string(i + 1) + " is not finite or further out than 1000000 m");
    }
  }
}

/// The waypoints that are apart from the one before.
std::vector<Eigen::Vector3d> distinct(const std::vector<Eigen::Vector3d>& waypoints_m,
                                      bool is_closed) {
  const auto are_close = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).norm() < kClosestWaypointsM;
  };
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& waypoint : waypoints_m) {
    if (kept.empty() || !are_close(kept.back(), waypoint)) {
      kept.push_back(waypoint);
    }
  }
  while (is_closed && kept.size() > 1 && are_close(kept.back(), kept.front())) {
    kept.pop_back();
  }
  if (kept.size() < 2) {
    throw Error(
        ErrorKind::kInput,
        "found " + std::to_string(kept.size()) + " waypoints that differ, expected at least 2");
  }
  return kept;
}

void check_length(const std::vector<Eigen::Vector3d>& waypoints_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < waypoints_m.size(); ++i) {
    length_m += (waypoints_m[i] - waypoints_m[i - 1]).norm();
  }
  if (length_m > kLongestPathM) {
    throw Error(ErrorKind::kInput,
                "the waypoints make a path of " + number_text("%.0f", length_m) +
                    " m, expected at most " + number_text("%.0f", kLongestPathM));
  }
}

/// Positions at equal steps of the flight along a path, at rest before and behind for `rest`
/// steps.
std::vector<Eigen::Vector3d> timed_positions(const FlightPath& path,
                                             const std::vector<double>& speeds_mps,
                                             const std::vector<double>& times_s,
                                             std::size_t rest) {
  const auto steps = static_cast<std::size_t>(std::ceil(times_s.back() / kMotionStepSeconds));
  std::vector<Eigen::Vector3d> positions(rest, path.points_m.front());
  positions.reserve(steps + 2 * rest);
  std::size_t i = 0;
  for (std::size_t step = 0; step < steps; ++step) {
    const double t_s = static_cast<double>(step) * kMotionStepSeconds;
    while (i + 2 < times_s.size() && t_s >= times_s[i + 1]) {
      ++i;
    }
    const double since_s = t_s - times_s[i];
    const double gain = (speeds_mps[i + 1] - speeds_mps[i]) / (times_s[i + 1] - times_s[i]);
    const double way_m = since_s * (speeds_mps[i] + 0.5 * gain * since_s);
    positions.push_back(path.point_m(i, std::clamp(way_m / path.lengths_m[i], 0.0, 1.0)));
  }
  positions.insert(positions.end(), rest, path.points_m.back());
  return positions;
}

}  // namespace

void check_limits(const FlightLimits& limits) {
  check_setting(limits.speed_mps, {.name = "speed_mps", .least = 0.05, .most = 50.0});
  check_setting(limits.acceleration_mps2,
                {.name = "acceleration_mps2", .least = 0.05, .most = 9.5});
  check_setting(limits.yaw_rate_radps, {.name = "yaw_rate_radps", .least = 0.05, .most = 10.0});
}

Trajectory fly_waypoints(const std::vector<Eigen::Vector3d>& waypoints_m,
                         const FlightLimits& limits,
                         bool is_closed) {
  check_limits(limits);
  check_waypoints(waypoints_m);
  const std::vector<Eigen::Vector3d> waypoints = distinct(waypoints_m, is_closed);
  check_length(waypoints);
  const FlightPath path = spline_path(waypoints, is_closed);
  const FlightLimits kept = {.speed_mps = kSpeedShare * limits.speed_mps,
                             .acceleration_mps2 = kAccelerationShare * limits.acceleration_mps2,
                             .yaw_rate_radps = limits.yaw_rate_radps};
  const std::vector<double> speeds = fastest_speeds(path, kept);
  const std::vector<double> times = times_at(path, speeds);
  const std::vector<double> weights = gaussian_weights(kSmoothingSeconds, kMotionStepSeconds);
  check_duration(times.back());
  SampledMotion motion;
  motion.positions_m = smoothed(timed_positions(path, speeds, times, weights.size() / 2), weights);
  motion.velocities_mps = spline_velocities(motion.positions_m, motion.step_s);
  motion.accelerations_mps2 = derivative(motion.velocities_mps, motion.step_s);
  return banked_trajectory(
      motion, yaw_along_motion(motion.velocities_mps, motion.step_s, limits.yaw_rate_radps));
}

}  // namespace skyhalo
