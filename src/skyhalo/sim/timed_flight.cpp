#include "skyhalo/sim/timed_flight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "skyhalo/sim/knot_curve.hpp"
#include "skyhalo/sim/sampled_motion.hpp"
#include "skyhalo/sim/setting_range.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"

namespace skyhalo {
namespace {

/// The angles without full turns between one and the next.
std::vector<Eigen::Vector3d> without_jumps(std::vector<Eigen::Vector3d> angles_rad) {
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double before = angles_rad[i - 1][axis];
      angles_rad[i][axis] =
          before + std::remainder(angles_rad[i][axis] - before, 2.0 * std::numbers::pi);
    }
  }
  return angles_rad;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& roll_pitch_yaw_rad) {
  return (Eigen::AngleAxisd(roll_pitch_yaw_rad.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(roll_pitch_yaw_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_pitch_yaw_rad.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// The curve's samples at equal steps from the first knot to the last.
SampledMotion sampled(const KnotCurve& curve, double start_s, double duration_s) {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kMotionStepSeconds)));
  SampledMotion motion;
  motion.step_s = duration_s / steps;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = start_s + duration_s * (static_cast<double>(i) / steps);
    motion.positions_m.push_back(curve.value(t_s));
    motion.velocities_mps.push_back(curve.slope(t_s));
  }
  motion.accelerations_mps2 = smoothed(derivative(motion.velocities_mps, motion.step_s),
                                       gaussian_weights(kSmoothingSeconds, motion.step_s));
  return motion;
}

Trajectory angled_trajectory(const SampledMotion& motion,
                             const std::vector<Eigen::Vector3d>& angles_rad) {
  std::vector<MotionSample> samples(motion.positions_m.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].T_map_body = make_pose(rotation_of(angles_rad[i]), motion.positions_m[i]);
    samples[i].velocity_mps = motion.velocities_mps[i];
    samples[i].t_s = static_cast<double>(i) * motion.step_s;
  }
  return Trajectory(std::move(samples));
}

}  // namespace

Trajectory fly_timed(const TimedKnots& knots, double yaw_rate_radps) {
  const double start_s = knots.times_s.front();
  const double duration_s = knots.times_s.back() - start_s;
  check_duration(duration_s);
  const SampledMotion motion =
      sampled(KnotCurve(knots.times_s, knots.positions_m), start_s, duration_s);
  const KnotCurve angle_curve(knots.times_s, without_jumps(knots.angles_rad));
  std::vector<double> yaws = yaw_along_motion(motion.velocities_mps, motion.step_s, yaw_rate_radps);
  std::vector<Eigen::Vector3d> angles_rad;
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    angles_rad.push_back(angle_curve.value(start_s + static_cast<double>(i) * motion.step_s));
    if (knots.has_yaw) {
      yaws[i] = angles_rad[i].z();
    }
    angles_rad[i].z() = yaws[i];
  }
  return knots.has_tilt ? angled_trajectory(motion, angles_rad) : banked_trajectory(motion, yaws);
}

}  // namespace skyhalo
