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
};

void add_source_options(CLI::App& command, SourceOptions& options);

/// Opens the recording at the path. Throws `Error` (input) when it is none that is known.
std::unique_ptr<KittiRawDrive> open_source(const SourceOptions& options,
                                           const DatasetConfig& config);

}  // namespace skyhalo::app
