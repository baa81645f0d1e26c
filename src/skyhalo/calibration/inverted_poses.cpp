#include "skyhalo/calibration/inverted_poses.hpp"

#include <cmath>
#include <string>

namespace skyhalo {
namespace {

/// How much of the baseline lies along the image rows, 0...1: along the mean of the two cameras' x
/// axes. 0 without a baseline.
double share_along_rows(const Pose& T_reference_left, const Pose& T_reference_right) {
  const Eigen::Vector3d baseline = T_reference_right.translation() - T_reference_left.translation();
  const Eigen::Vector3d rows = T_reference_left.linear().col(0) + T_reference_right.linear().col(0);
  const double lengths = baseline.norm() * rows.norm();
  return lengths > 0.0 ? std::abs(baseline.dot(rows)) / lengths : 0.0;
}

}  // namespace

void warn_if_poses_look_inverted(ImportedCameras& imported, std::string_view key) {
  if (imported.cameras.size() < 2) {
    return;
  }
  constexpr double kAcross = 0.8;  // more than 37 degrees off the rows
  constexpr double kAlong = 0.95;  // less than 18 degrees
  const Pose& left = imported.cameras[0].T_reference_camera;
  const Pose& right = imported.cameras[1].T_reference_camera;
  if (share_along_rows(left, right) < kAcross &&
      share_along_rows(left.inverse(), right.inverse()) > kAlong) {
    imported.warnings.push_back(
        std::string(key) +
        " looks inverted: the baseline does not lie along the image rows, but would if every " +
        std::string(key) + " were inverted");
  }
}

void warn_if_reference_is_camera(ImportedCameras& imported, std::string_view key) {
  if (!imported.cameras.empty() &&
      imported.cameras.front().T_reference_camera.isApprox(Pose::Identity(), 1e-12)) {
    imported.warnings.push_back(std::string(key) +
                                " of the first camera is the identity: what is "
                                "taken for the IMU is that camera");
  }
}

}  // namespace skyhalo
