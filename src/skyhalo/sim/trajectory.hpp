#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Where the body was at one moment of a motion, and how fast it moved.
struct MotionSample {
  Pose T_map_body = Pose::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< of the body's origin, along map axes
  double t_s = 0.0;
};

/// A motion of the body, known at every moment between samples: positions by cubic Hermite from
/// positions and velocities, attitudes by slerp. Time begins with 0 at the first sample; before
/// it and after the last one the motion stays as at that end. Every answer is the same bits on
/// each call and from each thread; nothing is kept between calls.
class Trajectory {
 public:
  /// Takes samples in the order of time; their times are moved for the first to be 0. Throws
  /// `Error` (input) unless there are two samples or more, all finite, with rotations, and times
  /// that increase.
  explicit Trajectory(std::vector<MotionSample> samples);

  /// The time of the last sample (s), more than 0.
  [[nodiscard]] double duration_s() const noexcept { return samples_.back().t_s; }

  /// The pose at a time (s); a time that is NaN is 0.
  [[nodiscard]] Pose T_map_body(double t_s) const noexcept;

  /// The velocity of the body's origin along the map's axes (m/s), the derivative of the position.
  [[nodiscard]] Eigen::Vector3d velocity_mps(double t_s) const noexcept;

  /// The acceleration of the body's origin along the map's axes (m/s^2), without gravity: zero in
  /// a hover. Linear between samples; at a sample that of the interval behind it.
  [[nodiscard]] Eigen::Vector3d acceleration_mps2(double t_s) const noexcept;

  [[nodiscard]] const std::vector<MotionSample>& samples() const noexcept { return samples_; }

 private:
  struct Moment {
    std::size_t index = 0;    // of the sample before
    double interval_s = 0.0;  // to the sample after
    double fraction = 0.0;    // 0 to 1 of that interval
  };

  [[nodiscard]] Moment moment(double t_s) const noexcept;

  std::vector<MotionSample> samples_;
};

}  // namespace skyhalo
