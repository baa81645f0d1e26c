#include "source.hpp"

#include <utility>

#include "rig_report.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"
#include "skyhalo/dataset/flight_recording.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/dataset/kitti_tracking.hpp"

namespace skyhalo::app {
namespace {

constexpr const char* kKnown =
    "a KITTI raw drive with image_00 or image_02 and oxts, a KITTI tracking folder with training/, "
    "a EuRoC flight with mav0/cam0 and mav0/cam1, or a skyhalo recording with flight.json";

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
  Recording recording;
  recording.frames = std::make_unique<EurocFlight>(options.path, std::move(opened.rig), T_body_imu);
  recording.T_body_imu = opened.T_body_imu;
  return recording;
}

/// The rig of `--rig` for a recording of KITTI; none without it.
std::optional<KittiRig> other_rig(const SourceOptions& options,
                                  const CommonOptions& common,
                                  const Config& config,
                                  Poses poses,
                                  Recording& recording) {
  recording.T_body_imu = Pose::Identity();
  if (options.rig.empty()) {
    return std::nullopt;
  }
  OpenedRig opened = open_rig(options.rig, common, config);
  expect_one_pair(opened, options);
  recording.T_body_imu = opened.T_body_imu;
  return KittiRig{std::move(opened.rig), place_of_imu(opened, options, poses)};
}

/// Takes the source for the recording's frames and laser.
template <class Source>
const Source& take(std::unique_ptr<Source> source, Recording& recording) {
  const Source& taken = *source;
  recording.laser = &taken;
  recording.frames = std::move(source);
  return taken;
}

Recording open_kitti_raw(const SourceOptions& options,
                         const CommonOptions& common,
                         const Config& config,
                         Poses poses) {
  Recording recording;
  std::optional<KittiRig> rig = other_rig(options, common, config, poses, recording);
  take(std::make_unique<KittiRawDrive>(options.path, config.dataset, std::move(rig)), recording);
  return recording;
}

/// The sequence of `--sequence`, or the only one.
std::string choose_sequence(const SourceOptions& options) {
  const std::vector<std::string> known = kitti_tracking_sequences(options.path);
  std::string list;
  for (const std::string& sequence : known) {
    if (sequence == options.sequence || (options.sequence.empty() && known.size() == 1)) {
      return sequence;
    }
    list += " " + sequence;
  }
  throw UsageError((options.sequence.empty()
                        ? "--sequence: expected one of"
                        : "--sequence " + options.sequence + ": " + options.path + " has") +
                   (list.empty() ? " none (calib/NNNN.txt)" : list));
}

Recording open_kitti_tracking(const SourceOptions& options,
                              const CommonOptions& common,
                              const Config& config,
                              Poses poses) {
  const std::string sequence = choose_sequence(options);
  Recording recording;
  std::optional<KittiRig> rig = other_rig(options, common, config, poses, recording);
  const auto& source = take(
      std::make_unique<KittiTrackingSequence>(options.path, sequence, std::move(rig)), recording);
  if (std::filesystem::exists(source.label_file())) {
    recording.label_file = source.label_file();
  }
  return recording;
}

Recording open_skyhalo(const SourceOptions& options,
                       const CommonOptions& common,
                       const Config& config) {
  std::optional<StereoRig> rig;
  if (!options.rig.empty()) {
    rig = open_rig(options.rig, common, config).rig;
  }
  Recording recording;
  recording.T_body_imu = Pose::Identity();
  const auto& source =
      take(std::make_unique<FlightRecording>(options.path, std::move(rig)), recording);
  if (!source.has_laser()) {
    recording.laser = nullptr;
  }
  if (source.has_objects()) {
    recording.own_boxes = [&source](int frame) { return source.boxes_in_body(frame); };
  }
  recording.takes_labels = false;
  return recording;
}

}  // namespace

void add_source_options(CLI::App& command, SourceOptions& options) {
  command
      .add_option("SOURCE",
                  options.path,
                  "the recording: a KITTI raw drive (…/2011_09_26/2011_09_26_drive_0013_sync), a "
                  "KITTI tracking folder (training/), a EuRoC flight (mav0/) or a recording of "
                  "skyhalo's own (flight.json)")
      ->required();
  add_format_options(command, options);
}

void add_format_options(CLI::App& command, SourceOptions& options) {
  const std::vector<std::string> formats{"auto", "kitti-raw", "kitti-tracking", "euroc", "skyhalo"};
  command
      .add_option("--format",
                  options.format,
                  "take the source for: auto, kitti-raw, kitti-tracking, euroc, skyhalo")
      ->check(CLI::IsMember(formats))
      ->capture_default_str();
  command
      .add_option("--sequence",
                  options.sequence,
                  "sequence of a KITTI tracking folder (default: the only one)")
      ->type_name("NNNN");
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

SourceFormat format_of(const SourceOptions& options) {
  const std::filesystem::path path(options.path);
  if (!std::filesystem::exists(path)) {
    throw input_error(path, std::string("no such folder; expected ") + kKnown);
  }
  const bool any = options.format == "auto";
  if (options.format == "skyhalo" || (any && is_flight_recording(path))) {
    return SourceFormat::kSkyhalo;
  }
  if (options.format == "euroc" || (any && is_euroc_flight(path))) {
    return SourceFormat::kEuroc;
  }
  // A sequence's folder looks like a drive, too, but for its calibration.
  if (options.format == "kitti-tracking" || (any && is_kitti_tracking(path))) {
    return SourceFormat::kKittiTracking;
  }
  if (any && !is_kitti_raw_drive(path)) {
    throw input_error(path,
                      std::string("is no recording that is known; expected ") + kKnown +
                          " (or force the format with --format)");
  }
  return SourceFormat::kKittiRaw;
}

Recording open_recording(const SourceOptions& options,
                         const CommonOptions& common,
                         const Config& config,
                         Poses poses) {
  const SourceFormat format = format_of(options);
  if (!options.sequence.empty() && format != SourceFormat::kKittiTracking) {
    throw UsageError("--sequence " + options.sequence +
                     ": only folders of KITTI's tracking benchmark have sequences");
  }
  switch (format) {
    case SourceFormat::kSkyhalo:
      return open_skyhalo(options, common, config);
    case SourceFormat::kEuroc:
      return open_euroc(options, common, config, poses);
    case SourceFormat::kKittiTracking:
      return open_kitti_tracking(options, common, config, poses);
    case SourceFormat::kKittiRaw:
      break;
  }
  return open_kitti_raw(options, common, config, poses);
}

}  // namespace skyhalo::app
