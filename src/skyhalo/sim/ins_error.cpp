#include "skyhalo/sim/ins_error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr double kStepS = 0.01;

double noise(std::initializer_list<std::uint64_t> key) {
  return static_cast<double>(gaussian(random_bits(key)));
}

}  // namespace

void check(const InsErrorConfig& config) {
  const auto expect = [](double value, double limit, const char* name) {
    if (!(value >= 0.0 && value <= limit)) {
      throw Error(ErrorKind::kInput,
                  std::string("ins: ") + name + ": expected 0..." +
                      std::to_string(static_cast<int>(limit)));
    }
  };
  expect(config.position_sigma_m, 100.0, "position_sigma_m");
  expect(config.attitude_sigma_rad, 1.0, "attitude_sigma_rad");
  expect(config.position_drift_m_per_sqrt_s, 100.0, "position_drift_m_per_sqrt_s");
  expect(config.yaw_drift_rad_per_sqrt_s, 1.0, "yaw_drift_rad_per_sqrt_s");
  expect(config.delay_s, 10.0, "delay_s");
}

InsError::InsError(const InsErrorConfig& config, double duration_s) : config_(config) {
  check(config);
  const auto steps = static_cast<std::size_t>(std::max(duration_s, 0.0) / kStepS) + 2;
  const double scale = std::sqrt(kStepS);
  Eigen::Vector4d drift = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < steps; ++i) {
    drift_.push_back(drift);
    for (int axis = 0; axis < 4; ++axis) {
      const double size =
          axis < 3 ? config.position_drift_m_per_sqrt_s : config.yaw_drift_rad_per_sqrt_s;
      drift[axis] += scale * size * noise({config.seed, 1, i, static_cast<std::uint64_t>(axis)});
    }
  }
}

Pose InsError::measured(const PoseAtTime& T_map_body, double t_s, std::uint64_t noise_key) const {
  const double then_s = t_s - config_.delay_s;
  const auto step = static_cast<std::size_t>(
      std::clamp(then_s / kStepS, 0.0, static_cast<double>(drift_.size() - 1)));
  const Eigen::Vector4d& drift = drift_[step];
  Eigen::Vector3d position_error_m = drift.head<3>();
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::uint64_t>(axis);
    position_error_m[axis] += config_.position_sigma_m * noise({config_.seed, 2, noise_key, a});
    turn_rad[axis] = config_.attitude_sigma_rad * noise({config_.seed, 3, noise_key, a});
  }
  const Pose T = T_map_body(then_s);
  const double angle_rad = turn_rad.norm();
  const Eigen::AngleAxisd sway(
      angle_rad,
      angle_rad > 0.0 ? Eigen::Vector3d(turn_rad / angle_rad) : Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd yaw(drift[3], Eigen::Vector3d::UnitZ());
  return make_pose((yaw * T.linear()) * sway.toRotationMatrix(),
                   T.translation() + position_error_m);
}

}  // namespace skyhalo
