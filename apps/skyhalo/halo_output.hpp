#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "halo_run.hpp"

namespace skyhalo::app {

/// A header and a line for each frame; empty where there is none.
[[nodiscard]] std::string halo_csv(const HaloRun& run);

/// How many frames, how fast, and how far laser and halo agree; without the source and the folder.
[[nodiscard]] nlohmann::json halo_summary(const HaloRun& run);

/// The summary (with its `out`) for people.
[[nodiscard]] std::string describe_halo(const nlohmann::json& summary);

}  // namespace skyhalo::app
