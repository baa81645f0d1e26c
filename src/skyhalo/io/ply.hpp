#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/types.hpp>
#include <vector>

namespace skyhalo {

/// A point with a colour, for viewers.
struct ColouredPoint {
  Eigen::Vector3f position_m;
  cv::Vec3b colour_bgr;
};

/// Writes points as binary little-endian PLY with `x y z` (float, m) and `red green blue` (uchar):
/// what CloudCompare, MeshLab, PCL and Blender open. Throws `Error` (failure) when it cannot be
/// written.
void write_ply(const std::filesystem::path& file, const std::vector<ColouredPoint>& points);

}  // namespace skyhalo
