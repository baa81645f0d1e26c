#include "skyhalo/dataset/euroc_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/euroc_table.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr std::size_t kFields = 16;  // position, quaternion, velocity, two biases
constexpr double kMaxFromUnit = 0.01;

/// Position x y z and quaternion w x y z.
std::array<double, 7> pose_numbers(const std::filesystem::path& file, const EurocRow& row) {
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<double> number = parse_number(row.fields[i]);
    if (!number) {
      throw input_error(file, row.line, "expected a finite number, found '" + row.fields[i] + "'");
    }
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace

std::vector<EurocPose> read_euroc_poses(const std::filesystem::path& file) {
  std::vector<EurocPose> poses;
  for (const EurocRow& row : read_euroc_table(file, kFields)) {
    const auto [x, y, z, qw, qx, qy, qz] = pose_numbers(file, row);
    const Eigen::Quaterniond q(qw, qx, qy, qz);
    if (!(std::abs(q.norm() - 1.0) <= kMaxFromUnit)) {
      throw input_error(file,
                        row.line,
                        "the quaternion has length " + std::to_string(q.norm()) +
                            ", expected a unit quaternion w, x, y, z");
    }
    poses.push_back({row.stamp, make_pose(q.normalized().toRotationMatrix(), {x, y, z})});
  }
  return poses;
}

std::optional<Pose> T_world_imu(std::span<const EurocPose> poses, Timestamp stamp) {
  const auto after = std::lower_bound(
      poses.begin(), poses.end(), stamp, [](const EurocPose& pose, Timestamp wanted) {
        return pose.stamp < wanted;
      });
  if (after == poses.end()) {
    return std::nullopt;
  }
  if (after->stamp == stamp) {
    return after->T_world_imu;
  }
  if (after == poses.begin()) {
    return std::nullopt;
  }
  const auto before = std::prev(after);
  if (after->stamp - before->stamp > kMaxPoseGap) {
    return std::nullopt;
  }
  const double share = static_cast<double>((stamp - before->stamp).count()) /
                       static_cast<double>((after->stamp - before->stamp).count());
  const Pose& from = before->T_world_imu;
  const Pose& to = after->T_world_imu;
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(from.linear()).slerp(share, Eigen::Quaterniond(to.linear()));
  return make_pose(q.toRotationMatrix(),
                   (1.0 - share) * from.translation() + share * to.translation());
}

}  // namespace skyhalo
