#include "source.hpp"

#include <utility>

#include "rig_report.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"

namespace skyhalo::app {
namespace {

constexpr const char* kKnown =
    "a KITTI raw drive with image_00 or image_02 and oxts, or a EuRoC flight with mav0/cam0 and "
    "mav0/cam1";

/// The recording's poses are its IMU's: without its place the map would be turned.
Pose place_of_imu(const OpenedRig& opened, const SourceOptions& options, Poses poses) {
  if (!opened.T_body_imu && poses == Poses::kNeeded) {
    throw input_error(
        options.rig, "T_body_imu: this key is missing; the recording's poses are those of its IMU");
  }
  return opened.T_body_imu.value_or(Pose::Identity());
}

/// The rig of a recording has its one pair.
void expect_one_pair(const OpenedRig& opened, const SourceOptions& options) {
  if (opened.rig.pairs.size() != 1) {
    throw input_error(options.rig.empty() ? options.path : options.rig,
                      "pairs: expected one, for the two cameras of the recording");
  }
}

OpenedRig own_rig_of_euroc(const SourceOptions& options, const CommonOptions& common) {
  ImportOptions import;
  import.format = CalibrationFormat::kEuroc;
  const ImportResult imported = import_calibration({options.path}, import);
  print_warnings(common, imported.warnings);
  return {resolve(imported.rig), imported.rig.T_body_imu};
}

Recording open_euroc(const SourceOptions& options,
                     const CommonOptions& common,
                     const Config& config,
                     Poses poses) {
  OpenedRig opened = options.rig.empty() ? own_rig_of_euroc(options, common)
                                         : open_rig(options.rig, common, config);
  expect_one_pair(opened, options);
  const Pose T_body_imu = place_of_imu(opened, options, poses);
  return {std::make_unique<EurocFlight>(options.path, std::move(opened.rig), T_body_imu),
          opened.T_body_imu};
}

Recording open_kitti(const SourceOptions& options,
                     const CommonOptions& common,
                     const Config& config,
                     Poses poses) {
  if (options.rig.empty()) {
    return {std::make_unique<KittiRawDrive>(options.path, config.dataset), Pose::Identity()};
  }
  OpenedRig opened = open_rig(options.rig, common, config);
  expect_one_pair(opened, options);
  const Pose T_body_imu = place_of_imu(opened, options, poses);
  return {std::make_unique<KittiRawDrive>(
              options.path, config.dataset, KittiRig{std::move(opened.rig), T_body_imu}),
          opened.T_body_imu};
}

}  // namespace

void add_source_options(CLI::App& command, SourceOptions& options) {
  command
      .add_option("SOURCE",
                  options.path,
                  "the recording: a KITTI raw drive (…/2011_09_26/2011_09_26_drive_0013_sync) or a "
                  "EuRoC flight (mav0/)")
      ->required();
  command.add_option("--format", options.format, "take the source for: auto, kitti-raw, euroc")
      ->check(CLI::IsMember({"auto", "kitti-raw", "euroc"}))
      ->capture_default_str();
}

void add_rig_option(CLI::App& command, SourceOptions& options) {
  command
      .add_option("--rig", options.rig, "rig file of the cameras (default: the recording's own)")
      ->type_name("FILE");
}

OpenedRig open_rig(const std::string& file, const CommonOptions& common, const Config& config) {
  StereoRig rig = load_rig(file);
  const RigFile read = read_rig_file(file);
  print_warnings(common, read.warnings);
  print_warnings(common, check_rig(read.description, check_settings(config)).warnings);
  return {std::move(rig), read.description.T_body_imu};
}

Recording open_recording(const SourceOptions& options,
                         const CommonOptions& common,
                         const Config& config,
                         Poses poses) {
  const std::filesystem::path path(options.path);
  if (!std::filesystem::exists(path)) {
    throw input_error(path, std::string("no such folder; expected ") + kKnown);
  }
  if (options.format == "euroc" || (options.format == "auto" && is_euroc_flight(path))) {
    return open_euroc(options, common, config, poses);
  }
  if (options.format == "auto" && !is_kitti_raw_drive(path)) {
    throw input_error(path,
                      std::string("is no recording that is known; expected ") + kKnown +
                          " (or force the format with --format)");
  }
  return open_kitti(options, common, config, poses);
}

std::unique_ptr<KittiRawDrive> open_drive(const SourceOptions& options,
                                          const DatasetConfig& config) {
  const std::filesystem::path path(options.path);
  if (!std::filesystem::exists(path)) {
    throw input_error(path, "no such folder; expected a KITTI raw drive");
  }
  if (options.format != "kitti-raw" && !is_kitti_raw_drive(path)) {
    throw input_error(path,
                      "is no recording with a laser that is known; expected a KITTI raw drive with "
                      "image_00 or image_02 and oxts (or force the format with --format)");
  }
  return std::make_unique<KittiRawDrive>(path, config);
}

}  // namespace skyhalo::app
