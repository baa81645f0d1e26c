#include "skyhalo/sim/sampled_motion.hpp"

#include <cmath>
#include <utility>

#include "skyhalo/sim/thrust_attitude.hpp"

namespace skyhalo {

std::vector<double> gaussian_weights(double deviation_s, double step_s) {
  const double deviation = deviation_s / step_s;
  const int reach = deviation < 1.0 ? 0 : static_cast<int>(std::lround(3.0 * deviation));
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    const double z = reach == 0 ? 0.0 : k / deviation;
    weights.push_back(std::exp(-0.5 * z * z));
    sum += weights.back();
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

// The clamped cubic spline: v[i-1] + 4 v[i] + v[i+1] = 3 (p[i+1] - p[i-1]) / step.
std::vector<Eigen::Vector3d> spline_velocities(const std::vector<Eigen::Vector3d>& positions_m,
                                               double step_s) {
  const std::size_t count = positions_m.size();
  std::vector<Eigen::Vector3d> velocities(count, Eigen::Vector3d::Zero());
  std::vector<double> factors(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double pivot = 4.0 - factors[i - 1];
    const Eigen::Vector3d rise = 3.0 / step_s * (positions_m[i + 1] - positions_m[i - 1]);
    factors[i] = 1.0 / pivot;
    velocities[i] = (rise - velocities[i - 1]) / pivot;
  }
  for (std::size_t i = count - 1; i-- > 1;) {
    velocities[i] -= factors[i] * velocities[i + 1];
  }
  return velocities;
}

std::vector<Eigen::Vector3d> derivative(const std::vector<Eigen::Vector3d>& values, double step_s) {
  std::vector<Eigen::Vector3d> slopes;
  slopes.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, values.size() - 1);
    slopes.emplace_back((values[after] - values[before]) /
                        (static_cast<double>(after - before) * step_s));
  }
  return slopes;
}

Trajectory banked_trajectory(const SampledMotion& motion, const std::vector<double>& yaws_rad) {
  std::vector<MotionSample> samples(motion.positions_m.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].T_map_body = make_pose(thrust_attitude(motion.accelerations_mps2[i], yaws_rad[i]),
                                      motion.positions_m[i]);
    samples[i].velocity_mps = motion.velocities_mps[i];
    samples[i].t_s = static_cast<double>(i) * motion.step_s;
  }
  return Trajectory(std::move(samples));
}

}  // namespace skyhalo
