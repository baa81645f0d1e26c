// Scans into maps of all kinds beside OctoMap, in the same run, on one thread; process CPU time and
// accuracy in one row. Prints a page of tables.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "map_accuracy.hpp"
#include "map_clock.hpp"
#include "map_contenders.hpp"
#include "map_flight.hpp"
#include "map_storage.hpp"

namespace skyhalo::bench {
namespace {

struct Options {
  int repeat = 5;
  std::string only;
  std::string json_file;
  bool quick = false;
};

/// A row of the yardstick: scans of a scene into maps of one cell size.
struct Setting {
  std::string name;
  std::string scene_name;
  int rows;
  double voxel_m;
  Eigen::Vector3d local_size_m = Eigen::Vector3d::Zero();  ///< of a local map; 0 = global maps
  double wanted_ms = 0.0;
};

const std::array kSettings{
    Setting{"map/room/S16k/0.25", "room", 90, 0.25, {0, 0, 0}, 1.0},
    Setting{"map/room/S16k/0.10", "room", 90, 0.10, {0, 0, 0}, 5.0},
    Setting{"map/room/F100k/0.25", "room", 224, 0.25, {0, 0, 0}, 2.2},
    Setting{"map/room/F100k/0.10", "room", 224, 0.10, {0, 0, 0}, 15.0},
    Setting{"map/open/S16k/0.25", "open", 90, 0.25, {0, 0, 0}, 5.0},
    Setting{"map/open/S16k/0.10", "open", 90, 0.10, {0, 0, 0}, 25.0},
    Setting{"map/local_8x8x5/0.25", "room", 90, 0.25, {8, 8, 5}, 0.5},
    Setting{"map/local_8x8x5/0.25 (1 degree)", "room", 180, 0.25, {8, 8, 5}, 0.5},
    Setting{"map/local_20x20x10/0.10", "room", 90, 0.10, {20, 20, 10}, 12.0},
    Setting{"map/local_20x20x10/0.10 (1 degree)", "room", 180, 0.10, {20, 20, 10}, 12.0},
};

struct Result {
  std::string name;
  std::vector<double> times_ms;
  std::optional<MapScore> accuracy;
  double memory_mb = 0.0;
};

/// Times of more than this for all scans (s) are not measured again.
constexpr double kLongS = 5.0;

bool is_done(const Result& result, std::size_t scans) {
  return !result.times_ms.empty() &&
         result.times_ms.front() * static_cast<double>(scans) > 1000.0 * kLongS;
}

/// All contenders take turns, so that what else the machine does troubles them alike; each begins
/// with a fresh map. The first turn of ours warms up and is left out.
std::vector<Result> measure(const Flight& flight,
                            const std::vector<std::unique_ptr<Contender>>& maps,
                            const std::optional<MapTruth>& truth,
                            int repeat) {
  std::vector<Result> results(maps.size());
  for (int turn = 0; turn < repeat; ++turn) {
    for (std::size_t i = 0; i < maps.size(); ++i) {
      if (is_done(results[i], flight.scans.size())) {
        continue;
      }
      if (turn == 0 && maps[i]->name() != "OctoMap") {
        maps[i]->insert(flight.scans.front());
      }
      maps[i]->reset();
      const double start_ms = process_ms();
      for (const FlownScan& scan : flight.scans) {
        maps[i]->insert(scan);
      }
      results[i].times_ms.push_back((process_ms() - start_ms) /
                                    static_cast<double>(flight.scans.size()));
      if (turn == 0) {
        results[i].name = maps[i]->name();
        results[i].accuracy = truth ? std::optional(score(*maps[i], *truth)) : std::nullopt;
        results[i].memory_mb = static_cast<double>(maps[i]->memory_bytes()) / 1e6;
      }
    }
  }
  return results;
}

std::string cell_text(const char* format, double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string table_of(const std::vector<Result>& results) {
  std::string text =
      "| map | ms per scan | least | runs | free | surface | false | MB |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Result& result : results) {
    const double least_ms = *std::min_element(result.times_ms.begin(), result.times_ms.end());
    text += "| " + result.name + " | " + cell_text("%.3f", median(result.times_ms)) + " | " +
            cell_text("%.3f", least_ms) + " | " + std::to_string(result.times_ms.size()) + " | ";
    text += result.accuracy ? cell_text("%.3f %% | ", 100.0 * result.accuracy->free) +
                                  cell_text("%.2f %% | ", 100.0 * result.accuracy->surface_recall) +
                                  cell_text("%.4f %% | ", 100.0 * result.accuracy->false_occupied)
                            : "– | – | – | ";
    text += cell_text("%.2f |\n", result.memory_mb);
  }
  return text;
}

nlohmann::json json_of(const Setting& setting, const Result& result) {
  nlohmann::json row{{"row", setting.name},
                     {"map", result.name},
                     {"ms_per_scan", median(result.times_ms)},
                     {"runs_ms", result.times_ms},
                     {"wanted_ms", setting.wanted_ms},
                     {"memory_mb", result.memory_mb}};
  if (result.accuracy) {
    row["free"] = result.accuracy->free;
    row["surface_recall"] = result.accuracy->surface_recall;
    row["false_occupied"] = result.accuracy->false_occupied;
  }
  return row;
}

void run_setting(const Setting& setting, const Options& options, nlohmann::json& rows) {
  const bool is_local = !setting.local_size_m.isZero();
  const Flight flight = fly(setting.scene_name,
                            setting.rows,
                            options.quick ? 2 : 24,
                            is_local ? Sensor::kStereo : Sensor::kLaser);
  const auto maps = is_local ? local_maps(setting.local_size_m, setting.voxel_m)
                             : global_maps(flight, setting.voxel_m);
  const auto truth = is_local ? std::nullopt : std::optional(truth_of(flight, setting.voxel_m));
  const std::vector<Result> results = measure(flight, maps, truth, options.repeat);
  std::cout << "\n### " << setting.name << "\n\n"
            << 2 * setting.rows * setting.rows << " rays; wanted: at most " << setting.wanted_ms
            << " ms.\n\n"
            << table_of(results) << std::flush;
  for (const Result& result : results) {
    rows.push_back(json_of(setting, result));
  }
}

void run_storage(const Options& options) {
  for (const double voxel_m : {0.25, 0.10}) {
    const std::string name = voxel_m > 0.2 ? "map/storage/open/0.25" : "map/storage/open/0.10";
    if (name.find(options.only) != std::string::npos && (!options.quick || voxel_m > 0.2)) {
      const Flight flight = fly("open", 90, options.quick ? 2 : 24, Sensor::kLaser);
      std::cout << "\n### " << name << "\n\n"
                << storage_table(flight, voxel_m, options.repeat) << std::flush;
    }
  }
}

int run(int argc, char** argv) {
  CLI::App program("Times and scores the maps beside OctoMap");
  Options options;
  program.add_option("--repeat", options.repeat, "fresh maps per row")->check(CLI::Range(1, 1000));
  program.add_option("--only", options.only, "rows whose name has this part");
  program.add_option("--json", options.json_file, "write the rows to this file too");
  program.add_flag("--quick", options.quick, "two scans, cells of 0.25 m: that it runs at all");
  CLI11_PARSE(program, argc, argv);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::cout
      << "# Scans into maps\n\n"
         "Scans 0.5 m apart, 20 m of range, a made-up world; process CPU time in ms per scan on "
         "one thread, the mean over\nall scans of a fresh map, the median of the runs. Wanted "
         "times hold for the better method.\n\n"
      << kScoreDefinitions;
  nlohmann::json rows = nlohmann::json::array();
  for (const Setting& setting : kSettings) {
    const bool is_quick = setting.rows == 90 && setting.voxel_m > 0.2;
    if (setting.name.find(options.only) != std::string::npos && (is_quick || !options.quick)) {
      run_setting(setting, options, rows);
    }
  }
  run_storage(options);
  if (!options.json_file.empty()) {
    std::ofstream(options.json_file) << rows.dump(2) << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace skyhalo::bench

int main(int argc, char** argv) {
  try {
    return skyhalo::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
