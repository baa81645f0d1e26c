#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo {

/// The step of generated motions (s): 100 Hz.
inline constexpr double kMotionStepSeconds = 0.01;

/// The standard deviation of the Gaussian that smooths generated motions (s).
inline constexpr double kSmoothingSeconds = 0.1;

/// The longest motion that is generated (s).
inline constexpr double kLongestMotionSeconds = 3600.0;

/// A motion of a point at equal steps of time, along the axes of `map`; all of one length.
struct SampledMotion {
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Vector3d> velocities_mps;
  std::vector<Eigen::Vector3d> accelerations_mps2;
  double step_s = kMotionStepSeconds;
};

/// The weights of a Gaussian from -3 to 3 standard deviations, as many on both sides of the
/// middle; their sum is 1. With a deviation of less than a step (s) a single 1.
[[nodiscard]] std::vector<double> gaussian_weights(double deviation_s, double step_s);

/// The values' convolution with an odd number of weights; before the first and behind the last
/// value those go on.
template <typename Value>
[[nodiscard]] std::vector<Value> smoothed(const std::vector<Value>& values,
                                          const std::vector<double>& weights) {
  const auto count = static_cast<std::ptrdiff_t>(values.size());
  const auto reach = static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::vector<Value> sums;
  sums.reserve(values.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Value sum = values.front() * 0.0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const auto from = std::clamp<std::ptrdiff_t>(i + k, 0, count - 1);
      sum += weights[static_cast<std::size_t>(k + reach)] * values[static_cast<std::size_t>(from)];
    }
    sums.push_back(sum);
  }
  return sums;
}

/// The velocities (m/s) with which the cubic Hermite curve through positions at equal steps has a
/// continuous acceleration, and is at rest at both ends. Needs two positions.
[[nodiscard]] std::vector<Eigen::Vector3d> spline_velocities(
    const std::vector<Eigen::Vector3d>& positions_m, double step_s);

/// The derivative of values at equal steps: central differences, one-sided ones at the ends. Needs
/// two values.
[[nodiscard]] std::vector<Eigen::Vector3d> derivative(const std::vector<Eigen::Vector3d>& values,
                                                      double step_s);

/// The motion with the attitude of its thrust and these yaws, one a sample (`thrust_attitude`).
[[nodiscard]] Trajectory banked_trajectory(const SampledMotion& motion,
                                           const std::vector<double>& yaws_rad);

}  // namespace skyhalo
