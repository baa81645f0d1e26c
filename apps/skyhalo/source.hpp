#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

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

/// Opens the recording at the path, with the cameras of `--rig` or else its own. Throws `Error`
/// (input) when it is none that is known.
std::unique_ptr<FrameSource> open_recording(const SourceOptions& options,
                                            const DatasetConfig& config);

/// Opens a recording that has laser scans. Throws `Error` (input) when it is none that is known.
std::unique_ptr<KittiRawDrive> open_drive(const SourceOptions& options,
                                          const DatasetConfig& config);

}  // namespace skyhalo::app
