#pragma once

#include <numbers>
#include <opencv2/core/types.hpp>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/map/decay.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"
#include "skyhalo/sphere/depth_rule.hpp"
#include "skyhalo/sphere/grid_geometry.hpp"
#include "skyhalo/sphere/pair_view.hpp"
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

/// From disparities to nearest distances by direction (thesis 5.3, 5.4).
struct SphereConfig {
  /// All directions: each pair's grid is the part of them that the pair sees.
  GridBounds bounds{.theta_min_rad = 0.0,
                    .theta_max_rad = std::numbers::pi,
                    .phi_min_rad = -std::numbers::pi,
                    .phi_max_rad = std::numbers::pi,
                    .step_rad = rad_from_deg(1.0)};
  DepthRule depth;            ///< but for its `min_range_m`, which is the pair's
  SeenRule seen;              ///< `near_m` at least: pairs that measure nothing there begin later
  double max_range_m = 33.0;  ///< points farther from the camera are left out, > 0
};

/// The occupancy map (thesis 6 and 7).
struct MapConfig {
  double voxel_m = 0.5;         ///< edge of a cell, > 0
  double log_odds_limit = 5.0;  ///< log odds are kept within +- this, in [0.001, 32]
  IntegrationMethod method = IntegrationMethod::kAuto;
  bool cell_size_term = true;  ///< see `IntegrationConfig`
  DecayConfig decay;
  double local_side_m = 8.0;    ///< local map: length and width, > 0
  double local_height_m = 5.0;  ///< local map: height, > 0
  int memory_mib = 512;         ///< sparse map: what stays in memory, 1...1048576
};

/// Everything that `ObstacleDetector` can be told.
struct DetectorConfig {
  MatchingConfig matching;
  SphereConfig sphere;
  SensorModelConfig sensor_model;
  MapConfig map;
};

/// The settings of the map's integrator.
[[nodiscard]] IntegrationConfig integration_config(const DetectorConfig& config);

/// A local map of the settings' size, round the origin.
[[nodiscard]] LocalMap make_local_map(const MapConfig& config);

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const DetectorConfig& config);

}  // namespace skyhalo
