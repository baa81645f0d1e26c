#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "common_options.hpp"
#include "interrupt.hpp"
#include "map_files.hpp"
#include "map_report.hpp"
#include "progress_bar.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/io/map_limits.hpp"
#include "skyhalo/io/map_merge.hpp"
#include "skyhalo/io/map_points.hpp"

namespace skyhalo::app {
namespace {

/// What the commands are told; each has some of it.
struct MapCommand {
  CommonOptions common;
  std::vector<std::string> files;
  std::string a;
  std::string b;
  std::string out;
  std::string slice;
  std::uint64_t memory_mib = kMapMemoryBytes >> 20U;
};

/// A bar over one file's work; Ctrl-C ends the work.
class FileBar {
 public:
  FileBar(const char* label, bool quiet) : bar_(label, kSteps, quiet) {}

  [[nodiscard]] Progress progress() {
    return [this](double share) {
      stop_if_interrupted();
      for (; done_ < static_cast<int>(share * kSteps); ++done_) {
        bar_.advance();
      }
    };
  }

 private:
  static constexpr int kSteps = 100;
  ProgressBar bar_;
  int done_ = 0;
};

LoadedMap load(const std::string& file, const MapCommand& options) {
  stop_if_interrupted();
  FileBar bar("read", options.common.quiet);
  return read_map(file, options.memory_mib << 20U, bar.progress());
}

void save(const MapOutput& output, const SparseMap& map, int limit_units, bool quiet) {
  FileBar bar("write", quiet);
  write_map(output, map, limit_units, bar.progress());
}

/// The limit of log odds that the configuration names.
int configured_limit(const Config& config) {
  return std::clamp(log_odds_units(config.detector.map.log_odds_limit), 1, -1 - kUnknown);
}

nlohmann::json file_json(const std::string& file, const LoadedMap& loaded, const Config& config) {
  const OccupancyRule rule = rule_of(config.evaluation.occupied_probability);
  nlohmann::json json = map_json(loaded.map, statistics_of(loaded.map, rule));
  json["file"] = file;
  json["format"] = name_of(loaded.format);
  json["file_bytes"] = file_bytes(file);
  json["log_odds_limit"] =
      loaded.limit_units ? nlohmann::json(kLogOddsPerUnit * *loaded.limit_units) : nlohmann::json();
  return json;
}

void info(const MapCommand& options) {
  const Config config = load_config(options.common);
  nlohmann::json summary = {{"maps", nlohmann::json::array()}};
  std::string text;
  for (const std::string& file : options.files) {
    const nlohmann::json map = file_json(file, load(file, options), config);
    text += describe_map(map);
    summary["maps"].push_back(map);
  }
  print_result(options.common, text, summary["maps"].size() == 1 ? summary["maps"][0] : summary);
}

/// What was written, for programs and for people.
void print_written(const CommonOptions& common, const MapOutput& output, nlohmann::json summary) {
  std::string names = output.file.string();
  if (output.format == MapFormat::kSlice) {
    std::filesystem::path file = output.file;
    names = file.replace_extension(".png").string() + " and ";
    names += file.replace_extension(".yaml").string();
  }
  summary["out"] = output.file.string();
  summary["format"] = name_of(output.format);
  const std::string text = std::to_string(summary["known_cells"].get<std::uint64_t>()) +
                           " known cells, " +
                           std::to_string(summary["occupied_cells"].get<std::uint64_t>()) +
                           " of them occupied\nWritten to " + names + "\n";
  print_result(common, text, summary);
}

void convert(const MapCommand& options) {
  const Config config = load_config(options.common);
  MapOutput output = parse_output(options.out, options.slice);
  output.rule = rule_of(config.evaluation.occupied_probability);
  const LoadedMap loaded = load(options.a, options);
  save(output,
       loaded.map,
       loaded.limit_units.value_or(configured_limit(config)),
       options.common.quiet);
  nlohmann::json summary = map_json(loaded.map, statistics_of(loaded.map, output.rule));
  summary["in"] = options.a;
  print_written(options.common, output, summary);
}

/// An error of two maps, with their names.
Error with_files(const Error& error, const std::string& a, const std::string& b) {
  return {error.kind(), a + ", " + b + ": " + error.what()};
}

void merge(const MapCommand& options) {
  const Config config = load_config(options.common);
  MapOutput output = parse_output(options.out, options.slice);
  output.rule = rule_of(config.evaluation.occupied_probability);
  const std::vector<std::string>& files = options.files;
  LoadedMap sum = load(files.front(), options);
  for (std::size_t i = 1; i < files.size(); ++i) {
    const LoadedMap next = load(files[i], options);
    try {
      add_log_odds(sum.map, next.map);
    } catch (const Error& error) {
      throw with_files(error, files.front(), files[i]);
    }
    if (next.limit_units) {
      sum.limit_units = std::max(*next.limit_units, sum.limit_units.value_or(1));
    }
  }
  const int limit_units = sum.limit_units.value_or(configured_limit(config));
  limit_log_odds(sum.map, limit_units);
  save(output, sum.map, limit_units, options.common.quiet);
  nlohmann::json summary = map_json(sum.map, statistics_of(sum.map, output.rule));
  summary["in"] = files;
  summary["log_odds_limit"] = kLogOddsPerUnit * limit_units;
  print_written(options.common, output, summary);
}

void compare(const MapCommand& options) {
  const Config config = load_config(options.common);
  const LoadedMap a = load(options.a, options);
  const LoadedMap b = load(options.b, options);
  nlohmann::json summary;
  try {
    summary = comparison_json(
        compare_maps(a.map, b.map, rule_of(config.evaluation.occupied_probability)));
  } catch (const Error& error) {
    throw with_files(error, options.a, options.b);
  }
  summary["a"] = options.a;
  summary["b"] = options.b;
  print_result(options.common, describe_comparison(summary), summary);
}

void add_read_options(CLI::App& command, MapCommand& options) {
  command
      .add_option("--max-memory-mib",
                  options.memory_mib,
                  "refuse a file whose map would take more than this")
      ->type_name("MIB")
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str();
  add_common_options(command, options.common);
}

void add_write_options(CLI::App& command, MapCommand& options) {
  command
      .add_option("--slice",
                  options.slice,
                  "for .png and .yaml: the heights (m) between which the map is seen from above")
      ->type_name("Z0:Z1");
}

constexpr const char* kFormats =
    "Formats, by extension:\n"
    "  .skymap      ours: all cells with their log odds, packed, with check sums\n"
    "  .ot          OctoMap: the same in an octree on multiples of the cell\n"
    "  .bt          OctoMap: free or occupied (log odds 0 or more) only\n"
    "  a folder     read only: the tiles that `run --tiles` keeps there, as one map\n";

constexpr const char* kPictures =
    "  .ply .pcd    written only: centres of occupied cells, coloured by height; with their\n"
    "               probability as intensity\n"
    "  .png .yaml   written only: a slice for ROS' map_server, both files; a column is occupied\n"
    "               (black) if any cell is, free (white) if any is and none occupied, else "
    "unknown\n";

constexpr const char* kStates =
    "A cell is occupied above evaluation.occupied_probability (--set; 0.7), free below 0.5, else\n"
    "unknown.\n";

void add_info(CLI::App& map) {
  auto options = std::make_shared<MapCommand>();
  CLI::App* command = map.add_subcommand(
      "info",
      std::string("what maps hold: cells, extent, log odds, memory\n") + kFormats + kStates);
  command->add_option("FILES", options->files, "the maps")->required();
  add_read_options(*command, *options);
  command->callback([options] { info(*options); });
}

void add_convert(CLI::App& map) {
  auto options = std::make_shared<MapCommand>();
  CLI::App* command =
      map.add_subcommand("convert",
                         std::string("a map in another format; an earlier file is replaced when "
                                     "the new one is whole\n") +
                             kFormats + kPictures + kStates +
                             "  skyhalo map convert flight.skymap floor.png --slice 0.2:1.5");
  command->add_option("IN", options->a, "the map")->required();
  command->add_option("OUT", options->out, "the file to write")->required();
  add_write_options(*command, *options);
  add_read_options(*command, *options);
  command->callback([options] { convert(*options); });
}

void add_merge(CLI::App& map) {
  auto options = std::make_shared<MapCommand>();
  CLI::App* command = map.add_subcommand(
      "merge",
      std::string("several maps of one place as one: the sum of their log odds, kept within the\n"
                  "largest of the maps' limits (map.log_odds_limit where none names one)\n"
                  "The cells must be the same: equal voxels, origins whole cells apart. The first\n"
                  "map's origin stays. The output comes first:\n"
                  "  skyhalo map merge both.skymap monday.skymap tuesday.skymap\n") +
          kFormats + kPictures);
  command->add_option("OUT", options->out, "the file to write")->required();
  command->add_option("FILES", options->files, "the maps, at least two")
      ->required()
      ->expected(2, 1 << 20);
  add_write_options(*command, *options);
  add_read_options(*command, *options);
  command->callback([options] { merge(*options); });
}

void add_compare(CLI::App& map) {
  auto options = std::make_shared<MapCommand>();
  CLI::App* command = map.add_subcommand(
      "compare",
      std::string("how two maps of one place differ: cells by what they are in each, and over\n"
                  "those known in both the correlation and largest difference of log odds\n"
                  "The cells must be the same: equal voxels, origins whole cells apart.\n") +
          kFormats + kStates);
  command->add_option("A", options->a, "the first map")->required();
  command->add_option("B", options->b, "the second map")->required();
  add_read_options(*command, *options);
  command->callback([options] { compare(*options); });
}

}  // namespace

void add_map(CLI::App& program) {
  CLI::App* map = program.add_subcommand("map", "look at map files, convert, merge, compare them");
  map->require_subcommand(1);
  add_info(*map);
  add_convert(*map);
  add_merge(*map);
  add_compare(*map);
}

}  // namespace skyhalo::app
