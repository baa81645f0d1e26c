#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "demo_flight.hpp"

namespace skyhalo::app {

/// `summary.json` of a demo and its `--json` line.
[[nodiscard]] nlohmann::json demo_summary(const DemoFlight& demo,
                                          const SimulatedFlight& flight,
                                          double duration_s);

/// What is printed.
[[nodiscard]] std::string demo_text(const nlohmann::json& summary);

/// `report.html`: one page with pictures, charts and numbers that opens offline.
[[nodiscard]] std::string demo_page(const DemoFlight& demo,
                                    const nlohmann::json& summary,
                                    const std::string& config_yaml);

}  // namespace skyhalo::app
