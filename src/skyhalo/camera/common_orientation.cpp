#include "skyhalo/camera/common_orientation.hpp"

#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

Error refusal(const std::string& message) {
  return {ErrorKind::kInput, "T_right_left: " + message};
}

}  // namespace

CommonOrientation common_orientation(const Pose& T_right_left) {
  const Eigen::Vector3d to_left = T_right_left.translation();
  const double baseline_m = to_left.norm();
  if (!(baseline_m > 1e-9) || !std::isfinite(baseline_m)) {
    throw refusal("the baseline is zero; expected two cameras side by side");
  }
  const Eigen::Vector3d x = -to_left / baseline_m;
  const Eigen::Vector3d left_axis = T_right_left.linear().col(2);
  const Eigen::Vector3d left_rows = T_right_left.linear().col(0);
  if (std::abs(x.x()) <= 0.5 || std::abs(x.dot(left_rows)) <= 0.5) {
    throw refusal(
        "the baseline lies across the image rows; the cameras stand above each other or look "
        "different ways, or the extrinsics are wrong");
  }
  if (!(x.x() > 0.5) || !(x.dot(left_rows) > 0.5)) {
    throw refusal(
        "the left camera does not stand to the left of the right one; left and right "
        "are swapped, or the extrinsics are inverted");
  }
  const Eigen::Vector3d between = left_axis + Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d z = (between - x * x.dot(between)).normalized();
  Eigen::Matrix3d R_right_cam;
  R_right_cam << x, z.cross(x), z;
  if (!R_right_cam.allFinite() || !(left_axis.z() > 0.0)) {
    throw refusal("the two cameras do not look the same way");
  }
  return {T_right_left.linear().transpose() * R_right_cam, R_right_cam, baseline_m};
}

}  // namespace skyhalo
