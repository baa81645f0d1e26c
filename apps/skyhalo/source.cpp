#include "source.hpp"

#include "skyhalo/base/error.hpp"

namespace skyhalo::app {

void add_source_options(CLI::App& command, SourceOptions& options) {
  command
      .add_option("SOURCE",
                  options.path,
                  "the recording: a KITTI raw drive (…/2011_09_26/2011_09_26_drive_0013_sync)")
      ->required();
  command.add_option("--format", options.format, "take the source for: auto, kitti-raw")
      ->check(CLI::IsMember({"auto", "kitti-raw"}))
      ->capture_default_str();
}

std::unique_ptr<KittiRawDrive> open_source(const SourceOptions& options,
                                           const DatasetConfig& config) {
  const std::filesystem::path path(options.path);
  if (!std::filesystem::exists(path)) {
    throw input_error(path, "no such folder; expected a KITTI raw drive");
  }
  if (options.format == "auto" && !is_kitti_raw_drive(path)) {
    throw input_error(path,
                      "is no recording that is known; expected a KITTI raw drive with image_00 "
                      "or image_02 and oxts (or force the format with --format)");
  }
  return std::make_unique<KittiRawDrive>(path, config);
}

}  // namespace skyhalo::app
