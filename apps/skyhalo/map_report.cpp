#include "map_report.hpp"

#include <array>
#include <iomanip>
#include <sstream>

#include "skyhalo/base/number_text.hpp"

namespace skyhalo::app {
namespace {

/// By `Occupancy`.
constexpr std::array kStates{"unknown", "free", "occupied"};

nlohmann::json list(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::string text_of(const nlohmann::json& number) {
  return number.is_null() ? "none" : number_text("%g", number.get<double>());
}

std::string point_text(const nlohmann::json& point_m) {
  return "(" + text_of(point_m[0]) + ", " + text_of(point_m[1]) + ", " + text_of(point_m[2]) + ")";
}

std::string share_text(const nlohmann::json& number) {
  return number.is_null() ? "none" : number_text("%.4f", number.get<double>());
}

}  // namespace

nlohmann::json map_json(const SparseMap& map, const MapStatistics& statistics) {
  const bool known = statistics.known_cells > 0;
  const VoxelLattice& lattice = map.lattice();
  return {{"voxel_m", lattice.voxel_m},
          {"origin_m", list(lattice.origin_m)},
          {"bricks", statistics.bricks},
          {"uniform_bricks", statistics.uniform_bricks},
          {"known_cells", statistics.known_cells},
          {"free_cells", statistics.free_cells},
          {"occupied_cells", statistics.occupied_cells},
          {"min_m", known ? list(lattice.corner_m(statistics.known.min)) : nlohmann::json()},
          {"max_m", known ? list(lattice.corner_m(statistics.known.max)) : nlohmann::json()},
          {"lowest_log_odds",
           known ? nlohmann::json(kLogOddsPerUnit * statistics.lowest) : nlohmann::json()},
          {"highest_log_odds",
           known ? nlohmann::json(kLogOddsPerUnit * statistics.highest) : nlohmann::json()},
          {"memory_bytes", map.memory_bytes()}};
}

std::string describe_map(const nlohmann::json& map) {
  std::ostringstream text;
  text << map["file"].get<std::string>() << ": " << map["format"].get<std::string>() << ", "
       << map["file_bytes"] << " bytes\n"
       << "  cells of " << text_of(map["voxel_m"]) << " m, cell (0, 0, 0) at "
       << point_text(map["origin_m"]) << " m\n"
       << "  " << map["known_cells"] << " known cells: " << map["occupied_cells"] << " occupied, "
       << map["free_cells"] << " free\n";
  if (!map["min_m"].is_null()) {
    text << "  from " << point_text(map["min_m"]) << " to " << point_text(map["max_m"]) << " m\n"
         << "  log odds from " << text_of(map["lowest_log_odds"]) << " to "
         << text_of(map["highest_log_odds"]);
    if (!map["log_odds_limit"].is_null()) {
      text << ", kept within " << text_of(map["log_odds_limit"]);
    }
    text << "\n";
  }
  text << "  " << map["bricks"] << " bricks of 8 x 8 x 8 cells, " << map["uniform_bricks"]
       << " of them uniform; " << map["memory_bytes"] << " bytes of memory\n";
  return text.str();
}

nlohmann::json comparison_json(const MapComparison& comparison) {
  nlohmann::json cells;
  for (std::size_t a = 0; a < kStates.size(); ++a) {
    for (std::size_t b = 0; b < kStates.size(); ++b) {
      cells[kStates[a]][kStates[b]] = comparison.cells[a][b];
    }
  }
  nlohmann::json json = {{"cells", cells}, {"known_in_both", comparison.known_in_both}};
  const auto store = [&json](const char* key, const std::optional<double>& value) {
    json[key] = value ? nlohmann::json(*value) : nlohmann::json();
  };
  store("occupied_intersection_over_union", comparison.occupied_intersection_over_union);
  store("correlation", comparison.correlation);
  const std::optional<LargestDifference>& largest = comparison.largest_difference;
  json["largest_difference"] =
      largest ? nlohmann::json(kLogOddsPerUnit * largest->units) : nlohmann::json();
  json["largest_difference_at_m"] = largest ? list(largest->center_m) : nlohmann::json();
  return json;
}

std::string describe_comparison(const nlohmann::json& comparison) {
  constexpr int kWidth = 14;
  std::ostringstream text;
  text << "cells, by what they are in " << comparison["a"].get<std::string>() << " (down) and "
       << comparison["b"].get<std::string>() << " (across)\n"
       << std::setw(10) << "";
  for (const char* const state : kStates) {
    text << std::setw(kWidth) << state;
  }
  for (const char* const a : kStates) {
    text << "\n" << std::left << std::setw(10) << a << std::right;
    for (const char* const b : kStates) {
      text << std::setw(kWidth) << comparison["cells"][a][b].get<std::uint64_t>();
    }
  }
  text << "\noccupied: intersection over union "
       << share_text(comparison["occupied_intersection_over_union"]) << "\nlog odds of "
       << comparison["known_in_both"] << " cells known in both: correlation "
       << share_text(comparison["correlation"]) << ", largest difference "
       << text_of(comparison["largest_difference"]);
  if (!comparison["largest_difference_at_m"].is_null()) {
    text << " at " << point_text(comparison["largest_difference_at_m"]) << " m";
  }
  return text.str() + "\n";
}

}  // namespace skyhalo::app
