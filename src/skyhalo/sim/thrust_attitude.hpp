#pragma once

#include <Eigen/Core>
#include <vector>

namespace skyhalo {

/// The acceleration of gravity, towards -z of `map` (m/s^2).
inline constexpr double kGravityMps2 = 9.80665;

/// The attitude R_map_body of a multirotor that accelerates so (m/s^2, along the axes of `map`):
/// body z is along the thrust, acceleration + g upwards; body y is across the heading `yaw_rad`
/// (about z, 0 along x, positive to the left). Accelerating ahead with a is nose down by
/// atan(a / g), a positive rotation about y. No flips: a thrust whose upward part is less than
/// 3 m/s^2 is taken to have that much, and the tilt is never more than 80 degrees. Total for finite
/// input.
[[nodiscard]] Eigen::Matrix3d thrust_attitude(const Eigen::Vector3d& acceleration_mps2,
                                              double yaw_rad) noexcept;

/// The yaw (rad, continuous over full turns) at each of the velocities (m/s, map, at equal steps):
/// towards where they point across the ground, turning no faster than `rate_radps` and smoothly.
/// Below 0.2 m/s across the ground the last heading stays; before the first heading that one
/// holds, and 0 where there is none.
[[nodiscard]] std::vector<double> yaw_along_motion(
    const std::vector<Eigen::Vector3d>& velocities_mps, double step_s, double rate_radps);

}  // namespace skyhalo
