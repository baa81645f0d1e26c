#pragma once

#include <filesystem>
#include <string>

#include "common_options.hpp"
#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/sim/simulated_flight.hpp"

namespace skyhalo::app {

/// The layouts that a simulated flight can be written in.
enum class ExportFormat { kSkyhalo, kKittiTracking, kEuroc };

/// What is written where.
struct ExportSettings {
  ExportFormat format = ExportFormat::kSkyhalo;
  std::filesystem::path folder;
  int sequence = 0;        ///< KITTI
  bool with_truth = true;  ///< our own layout: depth and disparity, exact and seen cells
  bool with_laser = true;  ///< our own layout
  double voxel_m = 0.5;    ///< of the exact map
  int downscale = 2;       ///< of the pairs that do not say
  std::map<std::string, std::string> source = {};  ///< free words for the recording
};

/// The cameras that a layout asks for: of `rig` (none: such as the layout usually has), the pair
/// of that name; without a name all of them, in other layouts than our own the only one that fits.
/// KITTI's is rectified. Throws `UsageError` when none or several fit.
[[nodiscard]] RigDescription rig_for(ExportFormat format,
                                     const std::optional<RigDescription>& rig,
                                     const std::string& pair);

/// Renders and writes all frames. Without an end nothing stays.
void export_flight(const SimulatedFlight& flight,
                   const RigDescription& rig,
                   const ExportSettings& settings,
                   bool quiet);

}  // namespace skyhalo::app
