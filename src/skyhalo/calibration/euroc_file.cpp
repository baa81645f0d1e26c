#include "skyhalo/calibration/euroc_file.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "skyhalo/calibration/file_status.hpp"
#include "skyhalo/calibration/inverted_poses.hpp"
#include "skyhalo/calibration/lens_input.hpp"
#include "skyhalo/calibration/yaml_geometry.hpp"

namespace skyhalo {
namespace {

using std::filesystem::path;

constexpr const char* kIntrinsics = "intrinsics";
constexpr const char* kDistortion = "distortion_coefficients";
constexpr const char* kPose = "T_BS";

path sensor_file(const path& folder, std::size_t camera) {
  return folder / ("cam" + std::to_string(camera)) / "sensor.yaml";
}

/// The folder with cam0 in it: this one, or `mav0` in it.
path camera_folder(const path& folder) {
  return is_there(sensor_file(folder / "mav0", 0)) ? folder / "mav0" : folder;
}

std::vector<path> sensor_files(const path& folder) {
  const path cameras = camera_folder(folder);
  std::vector<path> files;
  while (is_there(sensor_file(cameras, files.size()))) {
    files.push_back(sensor_file(cameras, files.size()));
  }
  if (files.empty()) {
    throw input_error(folder, "expected cam0/sensor.yaml or mav0/cam0/sensor.yaml in this folder");
  }
  return files;
}

LensKind read_lens_kind(const YamlValue& sensor) {
  if (const auto model = sensor.find("camera_model"); model && model->text() != "pinhole") {
    throw model->error("'" + model->text() + "' is not supported; supported is pinhole");
  }
  const YamlValue distortion = sensor.at("distortion_model");
  const std::string name = distortion.text();
  if (name == "radial-tangential" || name == "radtan") {
    return LensKind::kRadialTangential;
  }
  if (name == "equidistant") {
    return LensKind::kKannalaBrandt;
  }
  throw distortion.error("'" + name +
                         "' is not supported; supported are radial-tangential and equidistant");
}

/// `cam0` of `cam0/sensor.yaml`, else the file's name.
std::string name_of(const path& file) {
  std::error_code ignored;  // without a working folder the name stays what the path says
  const std::string folder = absolute(file, ignored).parent_path().filename().string();
  return file.stem() == "sensor" ? folder : file.stem().string();
}

ImportedCamera read_camera(const path& file, std::vector<std::string>& warnings) {
  const YamlValue sensor = YamlValue::load(file);
  const Lens lens = lens_from({.kind = read_lens_kind(sensor),
                               .intrinsics = read_intrinsics(sensor.at(kIntrinsics)),
                               .distortion = sensor.at(kDistortion).numbers(),
                               .intrinsics_at = error_at(sensor, kIntrinsics),
                               .distortion_at = error_at(sensor, kDistortion)});
  return {name_of(file),
          {read_size_px(sensor.at("resolution")), lens},
          read_pose(sensor.at(kPose), warnings)};
}

}  // namespace

bool is_euroc_folder(const path& folder) {
  return is_there(sensor_file(camera_folder(folder), 0));
}

ImportedCameras read_euroc(const std::vector<path>& files) {
  const bool folder = files.size() == 1 && is_folder(files.front());
  ImportedCameras imported;
  imported.reference_is_imu = true;
  for (const path& file : folder ? sensor_files(files.front()) : files) {
    imported.cameras.push_back(read_camera(file, imported.warnings));
  }
  warn_if_reference_is_camera(imported, kPose);
  warn_if_poses_look_inverted(imported, kPose);
  return imported;
}

}  // namespace skyhalo
