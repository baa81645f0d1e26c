#pragma once

#include <Eigen/Core>
#include <vector>

#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo {

/// Positions that are passed at their times, and what else is known there; one length.
struct TimedKnots {
  std::vector<double> times_s;  ///< increasing, two or more
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Vector3d> angles_rad;  ///< roll, pitch, yaw; 0 where not known
  bool has_yaw = false;
  bool has_tilt = false;  ///< roll or pitch
};

/// A motion on the curve through knots (`KnotCurve`), sampled at 100 Hz. Angles that are known
/// follow a curve of the same kind, turning the short way between knots; otherwise the yaw is that
/// of the motion, no faster than `yaw_rate_radps`, and roll and pitch are those of the thrust,
/// smoothed in time with a Gaussian of 0.1 s. Throws `Error` (input) when it takes longer than an
/// hour.
[[nodiscard]] Trajectory fly_timed(const TimedKnots& knots, double yaw_rate_radps);

}  // namespace skyhalo
