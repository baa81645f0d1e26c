#include "skyhalo/calibration/basalt_file.hpp"

#include <string>

#include "skyhalo/calibration/image_size.hpp"
#include "skyhalo/calibration/inverted_poses.hpp"
#include "skyhalo/calibration/json_value.hpp"
#include "skyhalo/calibration/lens_input.hpp"

namespace skyhalo {
namespace {

// What visnav calls what Basalt calls `T_imu_cam` and `intrinsics`.
constexpr const char* kVisnavPoses = "cam.T_i_c";
constexpr const char* kVisnavIntrinsics = "cam.intrinsics";

/// A lens model, and what the coefficients after fx fy cx cy are called in both layouts.
struct Model {
  LensKind kind = LensKind::kRadialTangential;
  std::vector<std::string> basalt;
  std::vector<std::string> visnav;
};

Model model_of(const JsonValue& type) {
  const std::string name = type.text();
  if (name == "ds") {
    return {LensKind::kDoubleSphere, {"xi", "alpha"}, {"p1", "p2"}};
  }
  if (name == "eucm") {
    return {LensKind::kExtendedUnified, {"alpha", "beta"}, {"p1", "p2"}};
  }
  if (name == "kb4") {
    return {LensKind::kKannalaBrandt, {"k1", "k2", "k3", "k4"}, {"p1", "p2", "p3", "p4"}};
  }
  if (name == "pinhole") {
    return {LensKind::kRadialTangential, {}, {}};
  }
  if (name == "pinhole-radtan8") {
    const std::vector<std::string> names = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    return {LensKind::kRadialTangential, names, names};
  }
  throw type.error("'" + name +
                   "' is not supported; supported are ds, eucm, kb4, pinhole and pinhole-radtan8");
}

std::vector<double> read_numbers(const JsonValue& object, const std::vector<std::string>& keys) {
  std::vector<double> numbers;
  numbers.reserve(keys.size());
  for (const std::string& key : keys) {
    numbers.push_back(object.at(key).number());
  }
  return numbers;
}

ErrorAt error_at(const JsonValue& value) {
  return [value](std::string_view message) { return value.error(message); };
}

/// The lens of an object with fx fy cx cy and the model's coefficients.
Lens read_lens(const JsonValue& numbers, LensKind kind, const std::vector<std::string>& names) {
  const std::vector<double> k = read_numbers(numbers, {"fx", "fy", "cx", "cy"});
  return lens_from({.kind = kind,
                    .intrinsics = {k[0], k[1], k[2], k[3]},
                    .distortion = names.empty() ? no_distortion() : read_numbers(numbers, names),
                    .intrinsics_at = error_at(numbers),
                    .distortion_at = error_at(numbers)});
}

cv::Size checked_size_px(const JsonValue& width, const JsonValue& height) {
  return {image_side_px(width.whole_number(), error_at(width)),
          image_side_px(height.whole_number(), error_at(height))};
}

cv::Size read_size_px(const JsonValue& value) {
  const std::vector<JsonValue> items = value.items();
  if (items.size() != 2) {
    throw value.error("expected width and height, found " + std::to_string(items.size()) +
                      " numbers");
  }
  return checked_size_px(items[0], items[1]);
}

Pose read_pose(const JsonValue& value, std::vector<std::string>& warnings) {
  const std::vector<double> t = read_numbers(value, {"px", "py", "pz"});
  const std::vector<double> q = read_numbers(value, {"qw", "qx", "qy", "qz"});
  const Eigen::Matrix3d R =
      rotation_from(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), error_at(value), warnings);
  return make_pose(R, {t[0], t[1], t[2]});
}

/// One entry for each camera.
std::vector<JsonValue> read_list(const JsonValue& root, const std::string& key, std::size_t count) {
  const JsonValue list = root.at(key);
  std::vector<JsonValue> items = list.items();
  if (items.size() != count) {
    throw list.error("expected " + std::to_string(count) + " entries, one for each camera, found " +
                     std::to_string(items.size()));
  }
  return items;
}

std::vector<RawCamera> read_basalt_cameras(const JsonValue& root) {
  const std::vector<JsonValue> entries = root.at("intrinsics").items();
  const std::vector<JsonValue> sizes = read_list(root, "resolution", entries.size());
  std::vector<RawCamera> cameras;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Model model = model_of(entries[i].at("camera_type"));
    cameras.push_back(
        {read_size_px(sizes[i]), read_lens(entries[i].at("intrinsics"), model.kind, model.basalt)});
  }
  return cameras;
}

std::vector<RawCamera> read_visnav_cameras(const JsonValue& root) {
  std::vector<RawCamera> cameras;
  for (const JsonValue& entry : root.at(kVisnavIntrinsics).items()) {
    const Model model = model_of(entry.at("cam_type"));
    cameras.push_back({checked_size_px(entry.at("width"), entry.at("height")),
                       read_lens(entry, model.kind, model.visnav)});
  }
  return cameras;
}

}  // namespace

ImportedCameras read_basalt(const std::filesystem::path& file) {
  const JsonValue root = JsonValue::load(file).at("value0");
  const bool visnav = root.has(kVisnavPoses) || root.has(kVisnavIntrinsics);
  const char* const key = visnav ? kVisnavPoses : "T_imu_cam";
  const std::vector<RawCamera> cameras =
      visnav ? read_visnav_cameras(root) : read_basalt_cameras(root);
  const std::vector<JsonValue> poses = read_list(root, key, cameras.size());
  ImportedCameras imported;
  imported.reference_is_imu = true;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Pose T_imu_cam = read_pose(poses[i], imported.warnings);
    imported.cameras.push_back({"cam" + std::to_string(i), cameras[i], T_imu_cam});
  }
  warn_if_reference_is_camera(imported, key);
  warn_if_poses_look_inverted(imported, key);
  return imported;
}

}  // namespace skyhalo
