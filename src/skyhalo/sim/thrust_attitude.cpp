#include "skyhalo/sim/thrust_attitude.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyhalo/sim/sampled_motion.hpp"

namespace skyhalo {
namespace {

constexpr double kSlowestHeadingMps = 0.2;
constexpr double kLeastLiftMps2 = 3.0;
constexpr double kSteepestTangent = 5.6712818196177;  // of 80 degrees

/// The heading of each velocity, not limited; a slow one has that of the last one that was not.
std::vector<double> headings(const std::vector<Eigen::Vector3d>& velocities_mps) {
  const auto has_heading = [](const Eigen::Vector3d& velocity) {
    return velocity.head<2>().norm() >= kSlowestHeadingMps;
  };
  const auto first = std::find_if(velocities_mps.begin(), velocities_mps.end(), has_heading);
  double heading = first == velocities_mps.end() ? 0.0 : std::atan2(first->y(), first->x());
  std::vector<double> angles;
  angles.reserve(velocities_mps.size());
  for (const Eigen::Vector3d& velocity : velocities_mps) {
    heading = has_heading(velocity) ? std::atan2(velocity.y(), velocity.x()) : heading;
    angles.push_back(heading);
  }
  return angles;
}

}  // namespace

Eigen::Matrix3d thrust_attitude(const Eigen::Vector3d& acceleration_mps2, double yaw_rad) noexcept {
  Eigen::Vector3d thrust = acceleration_mps2 + Eigen::Vector3d(0.0, 0.0, kGravityMps2);
  thrust.z() = std::max({thrust.z(), kLeastLiftMps2, thrust.head<2>().norm() / kSteepestTangent});
  const Eigen::Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  Eigen::Matrix3d R_map_body;
  R_map_body.col(2) = thrust.normalized();
  R_map_body.col(1) = R_map_body.col(2).cross(ahead).normalized();
  R_map_body.col(0) = R_map_body.col(1).cross(R_map_body.col(2));
  return R_map_body;
}

std::vector<double> yaw_along_motion(const std::vector<Eigen::Vector3d>& velocities_mps,
                                     double step_s,
                                     double rate_radps) {
  std::vector<double> yaws = headings(velocities_mps);
  const double most_rad = rate_radps * step_s;
  for (std::size_t i = 1; i < yaws.size(); ++i) {
    const double turn = std::remainder(yaws[i] - yaws[i - 1], 2.0 * std::numbers::pi);
    yaws[i] = yaws[i - 1] + std::clamp(turn, -most_rad, most_rad);
  }
  return smoothed(yaws, gaussian_weights(kSmoothingSeconds, step_s));
}

}  // namespace skyhalo
