#pragma once

#include <Eigen/Geometry>

#include "skyhalo/config/config.hpp"
#include "skyhalo/dataset/frame_source.hpp"

namespace skyhalo {

/// Bounds (m, map frame) of a global map that follows a recording (METHOD 7): x from the rearmost
/// position to `ahead_m` beyond the foremost, y to `side_m` on both sides, z as configured. Where
/// the path leaves that strip sideways, y grows to `ahead_m` beyond it.
[[nodiscard]] Eigen::AlignedBox3d drive_bounds(const FrameSource& source,
                                               const BoundsConfig& config);

}  // namespace skyhalo
