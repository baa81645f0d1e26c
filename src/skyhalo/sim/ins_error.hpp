#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sim/render.hpp"

namespace skyhalo {

/// How wrong the poses are that an inertial navigation system gives.
struct InsErrorConfig {
  double position_sigma_m = 0.0;             ///< of each axis, new with each pose
  double attitude_sigma_rad = 0.0;           ///< of each axis, new with each pose
  double position_drift_m_per_sqrt_s = 0.0;  ///< random walk of each axis
  double yaw_drift_rad_per_sqrt_s = 0.0;     ///< random walk of the heading alone
  double delay_s = 0.0;                      ///< the pose is that of so long ago, 0...10
  std::uint64_t seed = 1;
};

/// Throws `Error` (input) naming what is outside its domain.
void check(const InsErrorConfig& config);

/// Poses as they are measured. Drift begins with none at time 0. Position and heading drift each on
/// their own, as those of an INS whose position is aided: a wrong heading does not bend the way.
class InsError {
 public:
  /// For times from 0 to `duration_s`. Throws as `check` does.
  InsError(const InsErrorConfig& config, double duration_s);

  /// The pose that is given out for a time. `noise_key` makes its noise.
  [[nodiscard]] Pose measured(const PoseAtTime& T_map_body,
                              double t_s,
                              std::uint64_t noise_key) const;

 private:
  InsErrorConfig config_;
  std::vector<Eigen::Vector4d> drift_;  // x, y, z (m) and yaw (rad), every 10 ms
};

}  // namespace skyhalo
