#include "skyhalo/sim/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/sim/hermite.hpp"

namespace skyhalo {
namespace {

constexpr double kRotationTolerance = 1e-6;

bool is_sound(const MotionSample& sample) {
  return std::isfinite(sample.t_s) && sample.velocity_mps.allFinite() &&
         sample.T_map_body.matrix().allFinite() &&
         is_rotation(sample.T_map_body.linear(), kRotationTolerance);
}

void check_samples(const std::vector<MotionSample>& samples) {
  if (samples.size() < 2) {
    throw Error(ErrorKind::kInput, "a trajectory needs two samples or more");
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_sound(samples[i])) {
      throw Error(
          ErrorKind::kInput,
          "sample " + std::to_string(i) + " of a trajectory is not finite or its rotation is none");
    }
    if (i > 0 &&
        !(samples[i].t_s - samples.front().t_s > samples[i - 1].t_s - samples.front().t_s)) {
      throw Error(ErrorKind::kInput,
                  "sample " + std::to_string(i) + " of a trajectory is not after the one before");
    }
  }
}

HermiteInterval interval(const MotionSample& before, const MotionSample& after, double interval_s) {
  return {.value_0 = before.T_map_body.translation(),
          .slope_0 = before.velocity_mps,
          .value_1 = after.T_map_body.translation(),
          .slope_1 = after.velocity_mps,
          .interval_s = interval_s};
}

}  // namespace

Trajectory::Trajectory(std::vector<MotionSample> samples) : samples_(std::move(samples)) {
  check_samples(samples_);
  const double start_s = samples_.front().t_s;
  for (MotionSample& sample : samples_) {
    sample.t_s -= start_s;
  }
}

Trajectory::Moment Trajectory::moment(double t_s) const noexcept {
  const double inside_s = t_s > 0.0 ? std::min(t_s, duration_s()) : 0.0;
  const auto after = std::upper_bound(
      samples_.begin() + 1, samples_.end() - 1, inside_s, [](double t, const MotionSample& sample) {
        return t < sample.t_s;
      });
  const MotionSample& before = *(after - 1);
  const double interval_s = after->t_s - before.t_s;
  return {.index = static_cast<std::size_t>(after - samples_.begin()) - 1,
          .interval_s = interval_s,
          .fraction = (inside_s - before.t_s) / interval_s};
}

Pose Trajectory::T_map_body(double t_s) const noexcept {
  const Moment at = moment(t_s);
  const MotionSample& before = samples_[at.index];
  const MotionSample& after = samples_[at.index + 1];
  const Eigen::Quaterniond q_0(before.T_map_body.linear());
  const Eigen::Quaterniond q_1(after.T_map_body.linear());
  return make_pose(q_0.slerp(at.fraction, q_1).normalized().toRotationMatrix(),
                   hermite_value(interval(before, after, at.interval_s), at.fraction));
}

Eigen::Vector3d Trajectory::velocity_mps(double t_s) const noexcept {
  const Moment at = moment(t_s);
  return hermite_slope(interval(samples_[at.index], samples_[at.index + 1], at.interval_s),
                       at.fraction);
}

Eigen::Vector3d Trajectory::acceleration_mps2(double t_s) const noexcept {
  const Moment at = moment(t_s);
  return hermite_bend(interval(samples_[at.index], samples_[at.index + 1], at.interval_s),
                      at.fraction);
}

}  // namespace skyhalo
