#pragma once

#include <octomap/Pointcloud.h>

#include <string>
#include <vector>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "support/map_scenes.hpp"

namespace skyhalo::bench {

/// How far the made-up sensor sees, and how exact it is: as a laser scanner, or as stereo cameras
/// of focal length x baseline 64 px m whose disparities are half a pixel off.
enum class Sensor { kLaser, kStereo };

inline constexpr double kRangeM = 20.0;

/// One scan of a world, for our maps and for OctoMap's.
struct FlownScan {
  RangeScan scan;
  Pose T_map_body;
  octomap::Pointcloud cloud;  ///< map frame; beyond the range where a ray meets nothing within it
  std::vector<Eigen::Vector3d> ends_m;  ///< where rays end on a surface (map frame)
};

/// Scans of a world by a body that flies through it, 0.5 m from one to the next, turning a little.
struct Flight {
  std::string scene_name;
  testing::MapScene scene;
  std::vector<FlownScan> scans;
  Eigen::AlignedBox3d bounds_m;  ///< what the scans can reach, on whole half metres
};

/// `scene_name`: "room" or "open"; `rows` of a grid over all directions.
[[nodiscard]] Flight fly(const std::string& scene_name, int rows, int scan_count, Sensor sensor);

}  // namespace skyhalo::bench
