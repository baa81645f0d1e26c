#include "run_tiles.hpp"

#include <chrono>
#include <vector>

#include "skyhalo/base/number_text.hpp"

namespace skyhalo::app {
namespace {

/// Tiles are in memory this much farther than the farthest points (m).
constexpr double kTilesMarginM = 10.0;

/// Tiles are written at least this often, in the recording's time.
constexpr std::chrono::seconds kFlushEvery{10};

constexpr double kBytesPerMib = 1048576.0;

std::uint64_t budget_bytes(const Config& config) {
  return static_cast<std::uint64_t>(config.detector.map.memory_mib) << 20U;
}

}  // namespace

RunTiles::RunTiles(const std::string& folder, const Config& config)
    : tiles_(folder,
             {.budget_bytes = budget_bytes(config),
              .reach_m = config.detector.sphere.max_range_m + kTilesMarginM,
              .limit_units = integration_config(config.detector).limit_units}),
      budget_mib_(config.detector.map.memory_mib) {}

void RunTiles::frame_done(Timestamp stamp, SparseMap& map) {
  if (stamp - flushed_ >= kFlushEvery) {
    tiles_.flush(map);
    flushed_ = stamp;
  }
}

bool RunTiles::gather(SparseMap& map) {
  tiles_.flush(map);
  whole_bytes_ = tiles_.whole_bytes(map);
  is_whole_ = tiles_.away_count() == 0 || whole_bytes_ <= std::uint64_t(budget_mib_) << 20U;
  if (is_whole_) {
    tiles_.bring_in_all(map);
  }
  return is_whole_;
}

void RunTiles::print_warnings(const CommonOptions& options) const {
  std::vector<std::string> warnings;
  for (const DamagedTile& tile : tiles_.damaged()) {
    warnings.push_back(tile.problem + (tile.set_aside.empty()
                                           ? std::string("; its space is unknown")
                                           : "; set aside as " + tile.set_aside.string() +
                                                 ", its space is unknown"));
  }
  if (!is_whole_) {
    warnings.push_back("the whole map would take " +
                       number_text("%.1f", static_cast<double>(whole_bytes_) / kBytesPerMib) +
                       " MiB, more than map.memory_mib (" + std::to_string(budget_mib_) +
                       "): it stays in " + tiles_.folder().string() +
                       "; for one file of it: " + command_for_one_file());
  }
  app::print_warnings(options, warnings);
}

nlohmann::json RunTiles::summary() const {
  nlohmann::json set_aside = nlohmann::json::array();
  for (const DamagedTile& tile : tiles_.damaged()) {
    if (!tile.set_aside.empty()) {
      set_aside.push_back(tile.set_aside.string());
    }
  }
  return {{"folder", tiles_.folder().string()},
          {"damaged", tiles_.damaged().size()},
          {"set_aside", set_aside},
          {"whole_map_mib", static_cast<double>(whole_bytes_) / kBytesPerMib},
          {"map_files", is_whole_},
          {"command_for_one_file",
           is_whole_ ? nlohmann::json() : nlohmann::json(command_for_one_file())}};
}

std::string RunTiles::command_for_one_file() const {
  return "skyhalo map convert " + tiles_.folder().string() + " map.skymap";
}

}  // namespace skyhalo::app
