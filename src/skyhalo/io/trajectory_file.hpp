#pragma once

#include <filesystem>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Where the vehicle was at one moment.
struct StampedPose {
  Timestamp stamp;
  Pose T_map_body = Pose::Identity();
};

/// Writes poses in the TUM format: `timestamp tx ty tz qx qy qz qw` (s, m, body to map), a line
/// each. Throws `Error` (failure) when it cannot be written.
void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& trajectory);

}  // namespace skyhalo
