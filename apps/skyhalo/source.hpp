#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common_options.hpp"
#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/dataset/laser_source.hpp"
#include "skyhalo/geometry/oriented_box.hpp"

namespace skyhalo::app {

/// Where the data comes from.
struct SourceOptions {
  std::string path;
  std::string format = "auto";
  std::string rig;
  std::string sequence;
};

void add_source_options(CLI::App& command, SourceOptions& options);

/// `--format` and `--sequence` without the path itself.
void add_format_options(CLI::App& command, SourceOptions& options);

/// `--rig`, for commands that can use other cameras' descriptions than the recording's own.
void add_rig_option(CLI::App& command, SourceOptions& options);

/// The cameras of a rig file, ready for use. What looks wrong in it is printed as a note.
struct OpenedRig {
  StereoRig rig;
  std::optional<Pose> T_body_imu;
};

OpenedRig open_rig(const std::string& file, const CommonOptions& common, const Config& config);

/// The layouts of recordings.
enum class SourceFormat { kKittiRaw, kKittiTracking, kEuroc, kSkyhalo };

/// What `--format` says, or what is found at the path. Throws `Error` (input) when it is none that
/// is known.
SourceFormat format_of(const SourceOptions& options);

/// The annotated boxes of a frame (m, annotation frame of the laser).
using BoxesOf = std::function<std::vector<OrientedBox>(int frame)>;

/// A recording and what it has beside images.
struct Recording {
  std::unique_ptr<FrameSource> frames;
  std::optional<Pose> T_body_imu;      ///< how its body stands to the IMU, where that is known
  const LaserSource* laser = nullptr;  ///< part of `frames`; none without a laser scanner
  std::filesystem::path label_file;    ///< KITTI's, where there is one; else empty
  BoxesOf own_boxes;                   ///< set when the recording has boxes of its own
  bool takes_labels = true;            ///< whether KITTI's labels can be those of the recording
};

/// Whether a command goes by the poses of a recording.
enum class Poses { kNeeded, kUnused };

/// Opens the recording at the path, with the cameras of `--rig` or else its own. Throws `Error`
/// (input) when it is none that is known, or needs poses that the rig cannot place, and
/// `UsageError` when `--sequence` does not fit it.
Recording open_recording(const SourceOptions& options,
                         const CommonOptions& common,
                         const Config& config,
                         Poses poses);

}  // namespace skyhalo::app
