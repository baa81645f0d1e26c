#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo::testing {

/// What a motion did at most, seen at 200 Hz.
struct MotionExtremes {
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double acceleration_step_mps2 = 0.0;  ///< between moments
  double turn_rate_radps = 0.0;
  double tilt_rad = 0.0;
  double velocity_error_mps = 0.0;  ///< from the positions' differences
};

inline double turn_between(const Pose& T_map_a, const Pose& T_map_b) {
  return Eigen::Quaterniond(T_map_a.linear()).angularDistance(Eigen::Quaterniond(T_map_b.linear()));
}

inline MotionExtremes extremes_of(const Trajectory& flight) {
  constexpr double kStep = 0.005;
  MotionExtremes found;
  const auto raise = [](double& most, double value) { most = std::max(most, value); };
  const auto steps = static_cast<int>(flight.duration_s() / kStep);
  for (int i = 0; i < steps; ++i) {
    const double t_s = kStep * i;
    const Pose T_map_before = flight.T_map_body(t_s);
    const Pose T_map_after = flight.T_map_body(t_s + kStep);
    const Eigen::Vector3d a_0 = flight.acceleration_mps2(t_s);
    const Eigen::Vector3d rise = (T_map_after.translation() - T_map_before.translation()) / kStep;
    raise(found.speed_mps, flight.velocity_mps(t_s).norm());
    raise(found.acceleration_mps2, a_0.norm());
    raise(found.acceleration_step_mps2, (flight.acceleration_mps2(t_s + kStep) - a_0).norm());
    raise(found.turn_rate_radps, turn_between(T_map_before, T_map_after) / kStep);
    raise(found.tilt_rad, std::acos(std::clamp(T_map_before.linear()(2, 2), -1.0, 1.0)));
    raise(found.velocity_error_mps, (flight.velocity_mps(t_s + 0.5 * kStep) - rise).norm());
  }
  return found;
}

/// Waypoints in a box of 20 m by 20 m by 6 m, some of them close to each other.
inline std::vector<Eigen::Vector3d> random_waypoints(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> across(-10.0, 10.0);
  std::uniform_real_distribution<double> up(0.0, 6.0);
  std::vector<Eigen::Vector3d> waypoints;
  for (int i = 0; i < count; ++i) {
    const double x = across(random);
    const double y = across(random);
    const Eigen::Vector3d point(x, y, up(random));
    const bool is_close = i > 0 && random() % 5 == 0;
    waypoints.push_back(is_close ? Eigen::Vector3d(waypoints.back() + 0.03 * point) : point);
  }
  return waypoints;
}

/// How near a flight comes to a point (m), seen at 1 kHz.
inline double nearest_m(const Trajectory& flight, const Eigen::Vector3d& point_m) {
  double nearest = 1e9;
  for (int i = 0; 0.001 * i <= flight.duration_s(); ++i) {
    nearest = std::min(nearest, (flight.T_map_body(0.001 * i).translation() - point_m).norm());
  }
  return nearest;
}

}  // namespace skyhalo::testing
