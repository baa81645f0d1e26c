#include "source.hpp"

#include <optional>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"

namespace skyhalo::app {
namespace {

constexpr const char* kKnown =
    "a KITTI raw drive with image_00 or image_02 and oxts, or a EuRoC flight with mav0/cam0 and "
    "mav0/cam1";

/// The cameras of `--rig`, where it is given.
std::optional<RigDescription> given_rig(const SourceOptions& options) {
  return options.rig.empty() ? std::nullopt : std::optional(read_rig_file(options.rig).description);
}

std::unique_ptr<FrameSource> open_euroc(const SourceOptions& options) {
  const std::optional<RigDescription> given = given_rig(options);
  const RigDescription rig =
      given ? *given
            : import_calibration({options.path}, {.format = CalibrationFormat::kEuroc, .mounting = {}, .size_px = {}, .name = "euroc"}).rig;
  return std::make_unique<EurocFlight>(options.path,
                                       given ? load_rig(options.rig) : resolve(rig),
                                       rig.T_body_imu.value_or(Pose::Identity()));
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

std::unique_ptr<FrameSource> open_recording(const SourceOptions& options,
                                            const DatasetConfig& config) {
  const std::filesystem::path path(options.path);
  if (!std::filesystem::exists(path)) {
    throw input_error(path, std::string("no such folder; expected ") + kKnown);
  }
  if (options.format == "euroc" || (options.format == "auto" && is_euroc_flight(path))) {
    return open_euroc(options);
  }
  if (options.format == "auto" && !is_kitti_raw_drive(path)) {
    throw input_error(path,
                      std::string("is no recording that is known; expected ") + kKnown +
                          " (or force the format with --format)");
  }
  if (options.rig.empty()) {
    return std::make_unique<KittiRawDrive>(path, config);
  }
  return std::make_unique<KittiRawDrive>(path, config, load_rig(options.rig));
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
