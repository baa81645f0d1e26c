#include "skyhalo/calibration/rig_findings.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kLongestBaselineM = 3.0;
constexpr double kLongestInCentimetresM = 20.0;
constexpr double kShortestBaselineM = 0.01;
constexpr double kFarthestCameraM = 10.0;
const cv::Size kLeastMatched(64, 48);

std::string metres(double length_m) {
  return number_text("%.4g", length_m) + " m";
}

void check_lengths(double pair_baseline_m,
                   const Pose& T_body_camera,
                   std::vector<std::string>& findings) {
  if (pair_baseline_m > kLongestBaselineM) {
    const bool millimetres = pair_baseline_m > kLongestInCentimetresM;
    findings.push_back("the baseline of " + metres(pair_baseline_m) + " looks like " +
                       (millimetres ? "millimetres" : "centimetres") + "; as such it would be " +
                       metres(pair_baseline_m / (millimetres ? 1000.0 : 100.0)));
  } else if (pair_baseline_m < kShortestBaselineM) {
    findings.push_back("the baseline of " + metres(pair_baseline_m) + " is very short");
  }
  if (T_body_camera.translation().norm() > kFarthestCameraM) {
    findings.push_back("the camera stands " + metres(T_body_camera.translation().norm()) +
                       " from the body's origin; is T_body_camera in millimetres?");
  }
}

/// The way from the right camera to the left one should lie along the rows of the right image.
void check_side(const RawPair& cameras,
                const Pose& T_body_camera,
                std::vector<std::string>& findings) {
  const Eigen::Vector3d to_left = cameras.T_right_left.translation().normalized();
  if (to_left.x() < -0.9) {
    return;
  }
  if (to_left.x() > 0.9) {
    findings.emplace_back(
        "the left camera stands to the right of the right one: left and right are swapped, or "
        "T_right_left is inverted");
    return;
  }
  const Pose T_body_left = T_body_camera * cameras.T_right_left;
  const Pose inverted = T_body_camera * T_body_left.inverse();
  const double off_rows = deg_from_rad(std::acos(std::clamp(-to_left.x(), -1.0, 1.0)));
  std::string finding =
      "the baseline lies " + number_text("%.0f", off_rows) + " degrees off the image rows: ";
  finding += std::abs(inverted.translation().normalized().x()) > 0.9
                 ? "the camera poses look inverted (T_camera_body instead of T_body_camera)"
                 : "the cameras stand above each other, or the extrinsics are wrong";
  findings.push_back(finding);
}

void check_camera(const char* side, const RawCamera& camera, std::vector<std::string>& findings) {
  const Intrinsics& f = intrinsics(camera.lens);
  const double off_u = f.cx_px / camera.size_px.width - 0.5;
  const double off_v = f.cy_px / camera.size_px.height - 0.5;
  if (std::abs(off_u) > 0.2 || std::abs(off_v) > 0.2) {
    findings.push_back(std::string(side) +
                       ": the principal point is far from the image's middle; do intrinsics_px "
                       "belong to another image size?");
  }
  if (std::abs(f.fx_px / f.fy_px - 1.0) > 0.1) {
    findings.push_back(std::string(side) + ": fx and fy differ by more than 10 %");
  }
}

void check_likeness(const RawPair& cameras, std::vector<std::string>& findings) {
  const double left_px = intrinsics(cameras.left.lens).fx_px;
  const double right_px = intrinsics(cameras.right.lens).fx_px;
  if (std::abs(left_px / right_px - 1.0) > 0.1) {
    findings.emplace_back("the focal lengths of left and right differ by more than 10 %");
  }
  if (cameras.left.size_px != cameras.right.size_px) {
    findings.emplace_back("the images of left and right differ in size");
  }
}

}  // namespace

std::vector<std::string> findings_on(const PairDescription& pair) {
  std::vector<std::string> findings;
  if (const auto* rectified = std::get_if<RectifiedPairDescription>(&pair.images)) {
    check_lengths(baseline_m(rectified->model), pair.T_body_camera, findings);
    return findings;
  }
  const RawPair& cameras = std::get<RawPairDescription>(pair.images).cameras;
  if (!(cameras.T_right_left.translation().norm() > 0.0)) {
    return findings;  // cannot be used at all
  }
  check_lengths(cameras.T_right_left.translation().norm(), pair.T_body_camera, findings);
  check_side(cameras, pair.T_body_camera, findings);
  check_camera("left", cameras.left, findings);
  check_camera("right", cameras.right, findings);
  check_likeness(cameras, findings);
  return findings;
}

std::vector<std::string> findings_on(const PairReport& pair) {
  std::vector<std::string> findings;
  const double up = deg_from_rad(std::asin(std::clamp(pair.axis_body.z(), -1.0, 1.0)));
  const Eigen::Vector3d columns_body = pair.axis_body.cross(pair.rows_body);
  const double roll = deg_from_rad(std::abs(std::atan2(pair.rows_body.z(), -columns_body.z())));
  if (up > 60.0) {
    findings.emplace_back(
        "looks up; is T_body_camera given in the axes of an IMU? Body is x forward, y left, z up");
  } else if (up > -60.0 && roll > 135.0) {
    findings.emplace_back("hangs upside down");
  } else if (up > -60.0 && roll > 45.0) {
    findings.emplace_back(
        "lies on its side; is T_body_camera given in the axes of an IMU? Body is x forward, "
        "y left, z up");
  }
  if (pair.matched_px.width < kLeastMatched.width ||
      pair.matched_px.height < kLeastMatched.height) {
    findings.push_back("the matched images have only " + std::to_string(pair.matched_px.width) +
                       " x " + std::to_string(pair.matched_px.height) + " pixels");
  }
  if (pair.kept_share < 0.1) {
    findings.push_back("masks_px and rcrop_px leave only " +
                       number_text("%.0f", 100.0 * pair.kept_share) + " % of the image");
  }
  if (pair.max_range_m && *pair.max_range_m <= pair.min_range_m) {
    findings.push_back("max_range_m lies below " + metres(pair.min_range_m) +
                       ", the nearest that the search for disparities reaches");
  }
  if (pair.seen_share < 0.7) {
    findings.push_back(
        "the cameras fill only " + number_text("%.0f", 100.0 * pair.seen_share) +
        " % of the rectified image; hfov_deg or vfov_deg is larger than their field");
  }
  return findings;
}

}  // namespace skyhalo
