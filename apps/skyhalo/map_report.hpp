#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "map_files.hpp"
#include "skyhalo/io/map_comparison.hpp"
#include "skyhalo/io/map_statistics.hpp"

namespace skyhalo::app {

/// What a map holds, for programs: lattice, bricks, cells, extent in metres, memory.
[[nodiscard]] nlohmann::json map_json(const SparseMap& map, const MapStatistics& statistics);

/// The same (with its `file`) for people.
[[nodiscard]] std::string describe_map(const nlohmann::json& map);

/// How two maps differ, for programs.
[[nodiscard]] nlohmann::json comparison_json(const MapComparison& comparison);

/// The same (with `a` and `b`, the files) for people.
[[nodiscard]] std::string describe_comparison(const nlohmann::json& comparison);

}  // namespace skyhalo::app
