#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Where the IMU was at one moment, in a world with z up.
struct EurocPose {
  Timestamp stamp;
  Pose T_world_imu = Pose::Identity();
};

/// Reads a EuRoC `state_groundtruth_estimate0/data.csv`: per line a time stamp (ns), position x y z
/// (m), quaternion w x y z, and velocity and biases, which are not used. Quaternions are
/// normalised. Throws `Error` (input) with file and line for a line that is malformed or whose
/// quaternion's length differs from 1 by more than 0.01.
[[nodiscard]] std::vector<EurocPose> read_euroc_poses(const std::filesystem::path& file);

/// Neighbouring poses farther apart in time say nothing about what lies between.
inline constexpr std::chrono::milliseconds kMaxPoseGap{200};

/// The pose at a moment: between the poses (ordered by time) before and after it, position in
/// proportion and orientation by slerp. None outside their span and in a gap above `kMaxPoseGap`.
[[nodiscard]] std::optional<Pose> T_world_imu(std::span<const EurocPose> poses, Timestamp stamp);

}  // namespace skyhalo
