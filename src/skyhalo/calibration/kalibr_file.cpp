#include "skyhalo/calibration/kalibr_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "skyhalo/calibration/inverted_poses.hpp"
#include "skyhalo/calibration/lens_input.hpp"
#include "skyhalo/calibration/yaml_geometry.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr const char* kIntrinsics = "intrinsics";
constexpr const char* kDistortionModel = "distortion_model";
constexpr const char* kDistortion = "distortion_coeffs";
constexpr const char* kChain = "T_cn_cnm1";

/// What a camera's entry says about its place.
struct Place {
  std::optional<Pose> T_imu_cam;
  std::optional<Pose> T_cam_previous;
};

Error not_supported(const YamlValue& value, const std::string& supported) {
  return value.error("'" + value.text() + "' is not supported; supported are " + supported);
}

Lens pinhole_lens(const YamlValue& camera) {
  LensInput input{.intrinsics = read_intrinsics(camera.at(kIntrinsics)),
                  .distortion = no_distortion(),
                  .intrinsics_at = error_at(camera, kIntrinsics),
                  .distortion_at = error_at(camera, kDistortion)};
  const YamlValue model = camera.at(kDistortionModel);
  const std::string name = model.text();
  if (name == "none") {
    return lens_from(input);
  }
  if (name != "radtan" && name != "equidistant") {
    throw not_supported(model, "radtan, equidistant and none");
  }
  input.kind = name == "radtan" ? LensKind::kRadialTangential : LensKind::kKannalaBrandt;
  input.distortion = camera.at(kDistortion).numbers();
  return lens_from(input);
}

/// The lenses with two shape numbers in front of the intrinsics and no further distortion.
Lens sphere_lens(const YamlValue& camera, LensKind kind) {
  const std::vector<double> numbers = camera.at(kIntrinsics).numbers(6);
  const auto model = camera.find(kDistortionModel);
  if (model && model->text() != "none") {
    throw not_supported(*model, "none for this camera_model");
  }
  return lens_from({.kind = kind,
                    .intrinsics = {numbers[2], numbers[3], numbers[4], numbers[5]},
                    .distortion = {numbers[0], numbers[1]},
                    .intrinsics_at = error_at(camera, kIntrinsics),
                    .distortion_at = error_at(camera, kIntrinsics)});
}

Lens read_lens(const YamlValue& camera) {
  const YamlValue model = camera.at("camera_model");
  const std::string name = model.text();
  if (name == "pinhole") {
    return pinhole_lens(camera);
  }
  if (name == "ds") {
    return sphere_lens(camera, LensKind::kDoubleSphere);
  }
  if (name == "eucm") {
    return sphere_lens(camera, LensKind::kExtendedUnified);
  }
  throw not_supported(model, "pinhole, ds and eucm");
}

std::optional<Pose> find_pose(const YamlValue& camera,
                              std::string_view key,
                              std::vector<std::string>& warnings) {
  const auto value = camera.find(key);
  return value ? std::optional(read_pose(*value, warnings)) : std::nullopt;
}

Place read_place(const YamlValue& camera, std::vector<std::string>& warnings) {
  Place place{.T_imu_cam = find_pose(camera, "T_imu_cam", warnings),
              .T_cam_previous = find_pose(camera, kChain, warnings)};
  if (const auto T_cam_imu = find_pose(camera, "T_cam_imu", warnings)) {
    place.T_imu_cam = T_cam_imu->inverse();
  }
  return place;
}

bool names_camera(std::string_view key) {
  constexpr std::string_view kCamera = "cam";
  return key.starts_with(kCamera) && parse_whole_number(key.substr(kCamera.size()));
}

/// The entries `cam0`, `cam1`, ... in the order of their numbers, whatever that of the file.
std::vector<YamlValue> camera_entries(const YamlValue& chain) {
  std::vector<YamlValue> cameras = {chain.at("cam0")};
  std::string next = "cam1";
  while (auto camera = chain.find(next)) {
    cameras.push_back(*std::move(camera));
    next = "cam" + std::to_string(cameras.size());
  }
  const std::vector<std::string> keys = chain.keys();
  const auto named = std::count_if(keys.begin(), keys.end(), names_camera);
  if (static_cast<std::size_t>(named) != cameras.size()) {
    throw chain.error(next, "this key is missing; cameras are numbered from cam0 without a gap");
  }
  return cameras;
}

/// Equal up to what Kalibr prints and people round: a millimetre and a third of a degree.
bool agree(const Pose& a, const Pose& b) {
  const Pose difference = a.inverse() * b;
  return difference.translation().norm() < 1e-3 &&
         Eigen::AngleAxisd(difference.linear()).angle() < 6e-3;
}

/// The complaint about a `T_cn_cnm1` that is not what the two IMU poses say; none when it is.
std::optional<std::string> contradiction(const Place& previous, const Place& place) {
  const Pose& T_cam_previous = *place.T_cam_previous;
  const Pose& T_imu_cam = *place.T_imu_cam;
  const Pose& T_imu_previous = *previous.T_imu_cam;
  const Pose by_imu = T_imu_cam.inverse() * T_imu_previous;
  if (agree(T_cam_previous, by_imu)) {
    return std::nullopt;
  }
  if (agree(T_cam_previous, by_imu.inverse())) {
    return "looks inverted: it is the inverse of what the poses to the IMU say, which are taken; "
           "it should take points of the camera before to this one";
  }
  if (agree(T_cam_previous, T_imu_cam * T_imu_previous.inverse())) {
    return "contradicts the poses to the IMU, which are taken but look inverted: T_cam_imu takes "
           "points of the IMU to the camera, T_imu_cam points of the camera to the IMU";
  }
  return "contradicts the poses to the IMU, which are taken";
}

void warn_of_contradictions(const std::vector<YamlValue>& cameras,
                            const std::vector<Place>& places,
                            std::vector<std::string>& warnings) {
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (!places[i].T_cam_previous) {
      continue;
    }
    if (const auto complaint = contradiction(places[i - 1], places[i])) {
      warnings.emplace_back(cameras[i].error(kChain, *complaint).what());
    }
  }
}

/// Puts the cameras where their poses to the IMU say.
void place_by_imu(ImportedCameras& imported,
                  const std::vector<YamlValue>& entries,
                  const std::vector<Place>& places) {
  imported.reference_is_imu = true;
  for (std::size_t i = 0; i < places.size(); ++i) {
    imported.cameras[i].T_reference_camera = *places[i].T_imu_cam;
  }
  warn_of_contradictions(entries, places, imported.warnings);
  const bool by_camera = entries.front().find("T_cam_imu").has_value();
  warn_if_poses_look_inverted(imported, by_camera ? "T_cam_imu" : "T_imu_cam");
}

/// Puts the cameras one after the other, from cam0.
void place_by_chain(ImportedCameras& imported,
                    const std::vector<YamlValue>& entries,
                    const std::vector<Place>& places) {
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (!places[i].T_cam_previous) {
      throw entries[i].error(
          kChain, "this key is missing, and not every camera has T_cam_imu or T_imu_cam");
    }
    imported.cameras[i].T_reference_camera =
        imported.cameras[i - 1].T_reference_camera * places[i].T_cam_previous->inverse();
    if (places[i].T_imu_cam.has_value() != places[0].T_imu_cam.has_value()) {
      imported.warnings.emplace_back(
          entries[i].error("the IMU is left out: not every camera has T_cam_imu").what());
    }
  }
}

}  // namespace

ImportedCameras read_kalibr(const std::filesystem::path& file) {
  const std::vector<YamlValue> entries = camera_entries(YamlValue::load(file));
  ImportedCameras imported;
  std::vector<Place> places;
  for (const YamlValue& entry : entries) {
    imported.cameras.push_back(
        {entry.path(), {read_size_px(entry.at("resolution")), read_lens(entry)}});
    places.push_back(read_place(entry, imported.warnings));
  }
  const bool all_to_imu = std::all_of(
      places.begin(), places.end(), [](const Place& place) { return place.T_imu_cam.has_value(); });
  if (all_to_imu) {
    place_by_imu(imported, entries, places);
  } else {
    place_by_chain(imported, entries, places);
  }
  return imported;
}

}  // namespace skyhalo
