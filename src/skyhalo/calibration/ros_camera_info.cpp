#include "skyhalo/calibration/ros_camera_info.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "skyhalo/calibration/lens_input.hpp"
#include "skyhalo/calibration/yaml_geometry.hpp"

namespace skyhalo {
namespace {

constexpr const char* kCameraMatrix = "camera_matrix";
constexpr const char* kDistortionModel = "distortion_model";
constexpr const char* kDistortion = "distortion_coefficients";
constexpr const char* kRotation = "rectification_matrix";
constexpr const char* kProjection = "projection_matrix";

/// What a file says about its camera: lens, and how its image becomes a rectified one.
struct CameraInfo {
  RawCamera camera;
  Eigen::Matrix3d R_rectified_camera = Eigen::Matrix3d::Identity();
  /// From the frame that the rectified images share to this one (m).
  Eigen::Vector3d t_rectified_m = Eigen::Vector3d::Zero();
};

std::vector<double> exactly(const YamlValue& file, const char* key, std::size_t count) {
  const YamlValue value = file.at(key);
  std::vector<double> numbers = matrix_numbers(value);
  if (numbers.size() != count) {
    throw value.error("expected " + std::to_string(count) + " numbers, found " +
                      std::to_string(numbers.size()));
  }
  return numbers;
}

cv::Size read_image_size_px(const YamlValue& file) {
  return {read_side_px(file.at("image_width")), read_side_px(file.at("image_height"))};
}

/// Lens and projection mean whole images with all their pixels.
void refuse_binning(const YamlValue& file) {
  for (const char* const key : {"binning_x", "binning_y"}) {
    const auto binning = file.find(key);
    if (binning && binning->whole_number() != 0 && binning->whole_number() != 1) {
      throw binning->error("binned images are not supported; expected 0 or 1, found " +
                           binning->text());
    }
  }
}

void refuse_cut(const YamlValue& roi, const char* key, std::initializer_list<int> whole) {
  const auto value = roi.find(key);
  if (value && std::find(whole.begin(), whole.end(), value->whole_number()) == whole.end()) {
    throw value->error("a part of the image is not supported; expected " +
                       std::to_string(*(whole.end() - 1)) + ", found " + value->text());
  }
}

void refuse_part(const YamlValue& file, const cv::Size& size_px) {
  if (const auto roi = file.find("roi")) {
    refuse_cut(*roi, "x_offset", {0});
    refuse_cut(*roi, "y_offset", {0});
    refuse_cut(*roi, "width", {size_px.width, 0});
    refuse_cut(*roi, "height", {size_px.height, 0});
  }
}

void expect_count(const YamlValue& file,
                  std::size_t found,
                  std::initializer_list<std::size_t> allowed) {
  if (std::find(allowed.begin(), allowed.end(), found) != allowed.end()) {
    return;
  }
  std::string expected;
  for (const std::size_t count : allowed) {
    expected += (expected.empty() ? "" : " or ") + std::to_string(count);
  }
  throw file.error(kDistortion,
                   "expected " + expected + " numbers for this " + kDistortionModel + ", found " +
                       std::to_string(found));
}

LensKind read_lens_kind(const YamlValue& file, std::size_t count) {
  const YamlValue model = file.at(kDistortionModel);
  const std::string name = model.text();
  if (name == "plumb_bob") {
    expect_count(file, count, {4, 5});
    return LensKind::kRadialTangential;
  }
  if (name == "rational_polynomial") {
    expect_count(file, count, {8});
    return LensKind::kRadialTangential;
  }
  if (name == "equidistant") {
    expect_count(file, count, {4});
    return LensKind::kKannalaBrandt;
  }
  throw model.error("'" + name +
                    "' is not supported; supported are plumb_bob, rational_polynomial and "
                    "equidistant");
}

Lens read_lens(const YamlValue& file) {
  const std::vector<double> distortion = matrix_numbers(file.at(kDistortion));
  return lens_from({.kind = read_lens_kind(file, distortion.size()),
                    .intrinsics = intrinsics_from(exactly(file, kCameraMatrix, 9),
                                                  error_at(file, kCameraMatrix)),
                    .distortion = distortion,
                    .intrinsics_at = error_at(file, kCameraMatrix),
                    .distortion_at = error_at(file, kDistortion)});
}

Eigen::Vector3d read_shift_m(const YamlValue& file) {
  const std::vector<double> p = exactly(file, kProjection, 12);
  if (!(p[0] > 0.0) || !(p[5] > 0.0) || p[10] != 1.0 || p[11] != 0.0) {
    throw file.error(kProjection,
                     "expected fx 0 cx Tx, 0 fy cy Ty, 0 0 1 0 with fx and fy above 0");
  }
  return {p[3] / p[0], p[7] / p[5], 0.0};
}

CameraInfo read_info(const YamlValue& file, std::vector<std::string>& warnings) {
  const cv::Size size_px = read_image_size_px(file);
  refuse_binning(file);
  refuse_part(file, size_px);
  return {{size_px, read_lens(file)},
          rotation_from(exactly(file, kRotation, 9), error_at(file, kRotation), warnings),
          read_shift_m(file)};
}

}  // namespace

ImportedCameras read_ros_camera_info(const std::filesystem::path& left,
                                     const std::filesystem::path& right) {
  ImportedCameras imported;
  const YamlValue right_file = YamlValue::load(right);
  const CameraInfo l = read_info(YamlValue::load(left), imported.warnings);
  const CameraInfo r = read_info(right_file, imported.warnings);
  if (l.t_rectified_m.x() == 0.0 && r.t_rectified_m.x() == 0.0) {
    throw right_file.error(
        kProjection,
        "expected -fx * baseline as the fourth number; it is 0 here and in " + left.string());
  }
  const Pose T_right_left = make_pose(r.R_rectified_camera.transpose(), Eigen::Vector3d::Zero()) *
                            make_pose(l.R_rectified_camera, r.t_rectified_m - l.t_rectified_m);
  imported.cameras = {{left.stem().string(), l.camera},
                      {right.stem().string(), r.camera, T_right_left.inverse()}};
  return imported;
}

}  // namespace skyhalo
