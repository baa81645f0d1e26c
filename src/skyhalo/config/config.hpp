#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skyhalo/pipeline/detector_config.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"

namespace skyhalo {

/// Which cameras of a data set with several pairs are used.
enum class CameraChoice {
  kAuto,    ///< grey where there is a grey pair, else colour
  kGrey,    ///< KITTI cameras 00 and 01
  kColour,  ///< KITTI cameras 02 and 03
};

/// How recordings are read.
struct DatasetConfig {
  CameraChoice cameras = CameraChoice::kAuto;
};

/// Where the global map lies when its bounds are not given: a box that follows the drive, in the
/// frame of the first pose (METHOD 7).
struct BoundsConfig {
  double ahead_m = 27.0;   ///< beyond the end of the drive
  double behind_m = 0.0;   ///< behind the start
  double side_m = 50.0;    ///< to the left and to the right of the x axis
  double bottom_m = -3.0;  ///< z0
  double top_m = 2.5;      ///< z1
};

/// How a map is scored (METHOD 7).
struct EvaluationConfig {
  double max_range_m = 33.0;          ///< laser points farther from the camera are left out
  double occupied_probability = 0.7;  ///< a cell is called occupied above this
  bool labels_may_end_early =
      false;  ///< accept a label file whose last frame is before the drive's
};

/// Every setting of the program. The aggregates' defaults are the program's defaults.
struct Config {
  DatasetConfig dataset;
  DetectorConfig detector;
  SafetyConfig safety;
  BoundsConfig bounds;
  EvaluationConfig evaluation;
};

/// Reads a YAML file over `config`: keys that the file leaves out stay as they are. Throws `Error`
/// (input) with file, line and key for syntax errors, unknown keys, wrong types and values outside
/// their domain.
void load_config(const std::filesystem::path& file, Config& config);

/// Sets one value from `section.key=value`. Throws `Error` (input) for unknown keys and wrong
/// types. Domains are for `check` to judge when all values are set, as some depend on each other.
void set_value(std::string_view assignment, Config& config);

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const Config& config);

/// The whole configuration as a commented YAML file; `load_config` reads it back unchanged.
[[nodiscard]] std::string to_yaml(const Config& config);

/// All keys with their defaults, units and meaning as a Markdown page.
[[nodiscard]] std::string to_markdown(const Config& config);

}  // namespace skyhalo
