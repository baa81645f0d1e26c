#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "skyhalo/sim/render.hpp"
#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo {

/// A spinning laser scanner with the angles of the Velodyne HDL-64E: 32 lasers from +2 to -8 1/3
/// degrees at steps of 1/3, 32 from -8.83 to -24.33 at steps of 1/2.
struct LaserScannerConfig {
  int azimuths = 2083;          ///< firings in a turn, 1...36000
  double range_sigma_m = 0.02;  ///< standard deviation of a range
  double max_range_m = 120.0;   ///< of a surface that throws back 80 % of the light
  double min_range_m = 0.9;     ///< nearer, nothing is returned
  double turn_s = 0.0;          ///< how long a turn takes; 0: all at once
};

/// A point that the laser was thrown back from.
struct LaserReturn {
  Eigen::Vector3f point_m;   ///< in the scanner's frame (x forward, z up) at its own time
  float reflectance = 0.0F;  ///< 0...1
  std::uint32_t object = 0;  ///< of `SceneHit`
  std::uint32_t triangle = 0;
};

/// The angle of each laser above the horizon (rad), from the highest to the lowest.
[[nodiscard]] std::vector<double> laser_elevations_rad();

/// One turn about the time in its middle; it begins and ends behind. `T_scene_laser` tells where
/// the scanner is, `noise_key` makes its noise. Water and sky return nothing, dark and slanted
/// surfaces nothing from afar.
[[nodiscard]] std::vector<LaserReturn> scan(const SceneMoment& moment,
                                            const PoseAtTime& T_scene_laser,
                                            double stamp_s,
                                            std::uint64_t noise_key,
                                            const LaserScannerConfig& config);

/// Throws `Error` (input) naming what is outside its domain.
void check(const LaserScannerConfig& config);

}  // namespace skyhalo
