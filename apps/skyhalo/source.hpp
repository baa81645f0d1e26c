#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "common_options.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"

namespace skyhalo::app {

/// Where the data comes from.
struct SourceOptions {
  std::string path;
  std::string format = "auto";
  std::string rig;
};

void add_source_options(CLI::App& command, SourceOptions& options);

/// `--rig`, for commands that can use other cameras' descriptions than the recording's own.
void add_rig_option(CLI::App& command, SourceOptions& options);

/// The cameras of a rig file, ready for use. What looks wrong in it is printed as a note.
struct OpenedRig {
  StereoRig rig;
  std::optional<Pose> T_body_imu;
};

OpenedRig open_rig(const std::string& file, const CommonOptions& common, const Config& config);

/// A recording and how its body stands to the IMU, where that is known.
struct Recording {
  std::unique_ptr<FrameSource> frames;
  std::optional<Pose> T_body_imu;
};

/// Whether a command goes by the poses of a recording.
enum class Poses { kNeeded, kUnused };

/// Opens the recording at the path, with the cameras of `--rig` or else its own. Throws `Error`
/// (input) when it is none that is known, or needs poses that the rig cannot place.
Recording open_recording(const SourceOptions& options,
                         const CommonOptions& common,
                         const Config& config,
                         Poses poses);

/// Opens a recording that has laser scans. Throws `Error` (input) when it is none that is known.
std::unique_ptr<KittiRawDrive> open_drive(const SourceOptions& options,
                                          const DatasetConfig& config);

}  // namespace skyhalo::app
