#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"
#include "skyhalo/sphere/grid_geometry.hpp"
#include "skyhalo/stereo/matcher_config.hpp"

namespace skyhalo {

/// From raw images to a cleaned disparity image (thesis 5.1, 5.2).
struct MatchingConfig {
  int downscale = 2;  ///< whole factor by which images are shrunk before matching, 1...16
  int rcrop_px =
      64;  ///< right-most columns of the matched image that are discarded (eq. 5.1), >= 0
  std::vector<cv::Rect> masks_px;  ///< airframe, in full-resolution pixels of every pair
  MatcherConfig matcher;
};

/// From disparities to nearest distances by direction (thesis 5.3).
struct SphereConfig {
  /// The thesis's front grid, at our step.
  GridBounds bounds{.theta_min_rad = rad_from_deg(40.0),
                    .theta_max_rad = rad_from_deg(140.0),
                    .phi_min_rad = rad_from_deg(-50.0),
                    .phi_max_rad = rad_from_deg(50.0),
                    .step_rad = rad_from_deg(1.0)};
  double sigma_threshold_m = 0.5;  ///< sigma_th of eq. 5.4, >= 0
  double sigma_factor = 3.0;       ///< the 3 of eq. 5.4, >= 0
  double max_range_m = 33.0;       ///< points farther from the camera are left out, > 0
};

/// The occupancy map (thesis 6 and 7.1).
struct MapConfig {
  double voxel_m = 0.5;         ///< edge of a cell, > 0
  double log_odds_limit = 5.0;  ///< log odds are kept within +- this, in [0.001, 32]
};

/// Everything that `ObstacleDetector` can be told.
struct DetectorConfig {
  MatchingConfig matching;
  SphereConfig sphere;
  SensorModelConfig sensor_model;
  MapConfig map;
};

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const DetectorConfig& config);

}  // namespace skyhalo
