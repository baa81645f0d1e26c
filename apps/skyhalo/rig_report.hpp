#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "skyhalo/calibration/rig_check.hpp"
#include "skyhalo/config/config.hpp"

namespace skyhalo::app {

/// What a rig is judged by, from the configuration.
RigCheckSettings check_settings(const Config& config);

/// The report as a table for people.
std::string rig_table(const RigReport& report, const RigCheckSettings& settings);

/// The report for programs.
nlohmann::json rig_json(const RigReport& report);

}  // namespace skyhalo::app
