#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skyhalo/calibration/rig_description.hpp"

namespace skyhalo {

/// What ranges and resolutions are judged by.
struct RigCheckSettings {
  int downscale = 2;             ///< for pairs that do not say
  int rcrop_px = 64;             ///< for pairs that do not say
  double max_disparity_px = 64;  ///< search range in the matched image
  double delta_d_px = 0.5;       ///< expected disparity error in the matched image
  double voxel_m = 0.5;          ///< edge of a map cell
};

/// What a pair comes to.
struct PairReport {
  std::string name;
  bool raw = false;  ///< its images are to be rectified
  PairModel model;   ///< at full resolution
  cv::Size size_px;  ///< of the rectified images, full resolution
  int downscale = 1;
  cv::Size matched_px;                     ///< size of the matched images
  double kept_share = 1.0;                 ///< of their pixels that masks and rcrop leave
  std::optional<double> max_range_m = {};  ///< as the rig says it
  FieldOfView field;                       ///< edge to edge
  Eigen::Vector3d axis_body;               ///< where the rectified right camera looks, unit vector
  Eigen::Vector3d rows_body;         ///< along its image rows, unit vector; the way of the baseline
  Eigen::Vector3d position_body_m;   ///< of the right camera
  double seen_share = 1.0;           ///< of the rectified pixels that both raw cameras see
  double min_range_m = 0.0;          ///< straight ahead, at the largest disparity
  double range_of_one_cell_m = 0.0;  ///< where the range uncertainty reaches one map cell
};

/// A rig's numbers, and what looks wrong in it: `pair NAME: ...`.
struct RigReport {
  std::vector<PairReport> pairs;  ///< of those that can be used
  std::vector<std::string> warnings;
  std::vector<std::string> unusable;  ///< `pairs[i].KEY: ...` of the pairs that cannot be used
};

/// Looks a rig over without refusing anything.
[[nodiscard]] RigReport check_rig(const RigDescription& rig, const RigCheckSettings& settings);

/// A direction of the body frame in words: "forward", "left, 10.0 degrees towards back, 5.0
/// degrees down".
[[nodiscard]] std::string in_words(const Eigen::Vector3d& direction_body);

}  // namespace skyhalo
