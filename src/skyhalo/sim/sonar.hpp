#pragma once

#include <cstdint>
#include <optional>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo {

/// An ultrasonic sensor that hears the nearest thing in a cone.
struct SonarConfig {
  Pose T_body_sonar = Pose::Identity();  ///< looks along its x axis
  double half_angle_rad = 0.26;          ///< of the cone
  double min_range_m = 0.2;
  double max_range_m = 6.0;
  double range_sigma_m = 0.02;  ///< standard deviation of a range
};

/// The range (m) of the nearest thing in the cone; none without an echo. Soft and slanted things
/// echo, too: it is a sensor in its best mood. Water echoes, which lasers do not see.
[[nodiscard]] std::optional<double> sonar_range_m(const SceneMoment& moment,
                                                  const Pose& T_scene_sonar,
                                                  std::uint64_t noise_key,
                                                  const SonarConfig& config);

}  // namespace skyhalo
