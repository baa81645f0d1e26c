#include <chrono>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <utility>

#include "commands.hpp"
#include "common_options.hpp"
#include "for_each_frame.hpp"
#include "run_tiles.hpp"
#include "skyhalo/dataset/drive_bounds.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/map_points.hpp"
#include "skyhalo/io/octomap_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/trajectory_file.hpp"
#include "skyhalo/map/to_sparse.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "source.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {
namespace {

struct RunOptions {
  CommonOptions common;
  SourceOptions source;
  std::string map = "global";
  std::string tiles;
  std::string frames;
  std::string out = "out/run";
};

/// The map that was asked for, empty.
OccupancyMap make_map(const std::string& kind, const FrameSource& source, const Config& config) {
  const MapConfig& map = config.detector.map;
  if (kind == "local") {
    return make_local_map(map);
  }
  if (kind == "sparse") {
    return SparseMap({.origin_m = Eigen::Vector3d::Zero(), .voxel_m = map.voxel_m});
  }
  return DenseMap(make_voxel_grid(drive_bounds(source, config.bounds), map.voxel_m));
}

/// The folder of a sparse map's far tiles, if there is one.
std::unique_ptr<RunTiles> open_tiles(const RunOptions& options, const Config& config) {
  if (options.tiles.empty()) {
    return nullptr;
  }
  if (options.map != "sparse") {
    throw UsageError("--tiles: only a sparse map (--map sparse) has tiles");
  }
  return std::make_unique<RunTiles>(options.tiles, config);
}

/// What a run leaves behind besides the map.
struct RunRecord {
  std::vector<StampedPose> trajectory;
  double duration_s = 0.0;
};

/// What a frame goes into.
struct RunTargets {
  ObstacleDetector& detector;
  RunTiles* tiles;
  StageClock& clock;
};

RunRecord run_frames(const FrameSource& source,
                     FrameRange range,
                     const RunTargets& targets,
                     ProgressBar& bar) {
  RunRecord record;
  SparseMap* const tiled =
      targets.tiles != nullptr ? &std::get<SparseMap>(targets.detector.map()) : nullptr;
  const auto start = std::chrono::steady_clock::now();
  for_each_frame(
      range,
      bar,
      [&](int frame) { return source.read(frame); },
      [&](int frame, const FrameSet& frames) {
        const Pose T_map_body = source.T_map_body(frame);
        if (tiled != nullptr) {
          targets.tiles->follow(T_map_body.translation(), *tiled);
        }
        targets.detector.process(frames, T_map_body, &targets.clock);
        if (tiled != nullptr) {
          targets.tiles->frame_done(frames.stamp, *tiled);
        }
        record.trajectory.push_back({frames.stamp, T_map_body});
      });
  record.duration_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return record;
}

/// All frames with a bar, and with tiles what was seen until an error or the end in their folder.
RunRecord run_all(const FrameSource& source,
                  FrameRange range,
                  const RunTargets& targets,
                  const CommonOptions& common) {
  try {
    ProgressBar bar("mapping", range.last - range.first + 1, common.quiet);
    return run_frames(source, range, targets, bar);
  } catch (const std::bad_alloc&) {
    // A scan or a tile may be in the map by half: the folder stays as it was last written.
    if (targets.tiles != nullptr) {
      targets.tiles->print_warnings(common);
    }
    throw;
  } catch (...) {
    if (targets.tiles != nullptr) {
      targets.tiles->print_warnings(common);
      targets.tiles->flush(std::get<SparseMap>(targets.detector.map()));
    }
    throw;
  }
}

/// Brings the tiles together, and tells what was wrong with them even when that fails.
bool gather(RunTiles& tiles, SparseMap& map, const CommonOptions& common) {
  try {
    const bool is_whole = tiles.gather(map);
    tiles.print_warnings(common);
    return is_whole;
  } catch (...) {
    tiles.print_warnings(common);
    throw;
  }
}

void write_map_files(const OutputFolder& out, const OccupancyMap& map, const Config& config) {
  std::optional<SparseMap> copy;
  const SparseMap* cells = std::get_if<SparseMap>(&map);
  if (cells == nullptr) {
    cells = &copy.emplace(std::visit([](const auto& kind) { return to_sparse(kind); }, map));
  }
  const double p_occupied = config.evaluation.occupied_probability;
  const DenseMap* const dense = std::get_if<DenseMap>(&map);
  write_ply(out.file("map.ply"),
            dense != nullptr ? occupied_points(*dense, p_occupied)
                             : coloured_by_height(occupied_points(*cells, rule_of(p_occupied))));
  write_octomap(out.file("map.ot"), *cells, OctreeForm::kFull);
  write_skymap(out.file("map.skymap"),
               *cells,
               {.limit_units = integration_config(config.detector).limit_units});
}

std::string describe(const nlohmann::json& summary, const std::vector<StageTimes>& stages) {
  std::ostringstream text;
  text << summary["frames"] << " frames, " << summary["dropped"] << " dropped, "
       << summary["frames_per_second"].get<double>() << " frames per second\n\n"
       << "| stage | p50 ms | p95 ms |\n|---|---|---|\n";
  for (const StageTimes& stage : stages) {
    text << "| " << stage.stage << " | " << stage.p50_ms << " | " << stage.p95_ms << " |\n";
  }
  const bool has_tiles = summary.contains("tiles");
  const bool has_map_files = !has_tiles || summary["tiles"]["map_files"].get<bool>();
  text << "\nWritten to " << summary["out"].get<std::string>() << ": summary.json, "
       << (has_map_files ? "map.ply, map.ot, map.skymap, " : "") << "trajectory.tum\n";
  if (has_tiles) {
    text << "The map's tiles are in " << summary["tiles"]["folder"].get<std::string>() << "\n";
  }
  return text.str();
}

void run(const RunOptions& options) {
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const auto source = open_recording(options.source, options.common, config, Poses::kNeeded).frames;
  const FrameRange range = parse_frames(options.frames, source->frame_count());
  const std::unique_ptr<RunTiles> tiles = open_tiles(options, config);
  OutputFolder out(options.out);
  ObstacleDetector detector(source->rig(), config.detector, make_map(options.map, *source, config));
  StageClock clock;
  const RunRecord record = run_all(*source, range, {detector, tiles.get(), clock}, options.common);
  const auto frames = static_cast<double>(record.trajectory.size());
  nlohmann::json summary = {
      {"source", source->name()},
      {"map", options.map},
      {"frames", record.trajectory.size()},
      {"dropped", range.last - range.first + 1 - static_cast<int>(record.trajectory.size())},
      {"seconds", record.duration_s},
      {"frames_per_second", frames / record.duration_s},
      {"stages", stages_json(clock.times())},
      {"out", options.out}};
  bool has_whole_map = true;
  if (tiles != nullptr) {
    has_whole_map = gather(*tiles, std::get<SparseMap>(detector.map()), options.common);
    summary["tiles"] = tiles->summary();
  }
  if (has_whole_map) {
    write_map_files(out, detector.map(), config);
  } else {
    for (const char* const name : {"map.ply", "map.ot", "map.skymap"}) {
      out.leave_out(name);
    }
  }
  write_tum(out.file("trajectory.tum"), record.trajectory);
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  stop_if_interrupted();
  out.commit();
  print_result(options.common, describe(summary, clock.times()), summary);
}

}  // namespace

void add_run(CLI::App& program) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run",
                                             "detection and mapping over a recording\n"
                                             "writes summary.json, map.ply (occupied cells), "
                                             "map.ot (OctoMap), map.skymap and trajectory.tum");
  add_source_options(*command, options->source);
  add_rig_option(*command, options->source);
  command
      ->add_option("--map",
                   options->map,
                   "kind of map: global (fixed bounds round the drive), local (follows the drone), "
                   "sparse (no bounds)")
      ->check(CLI::IsMember({"global", "local", "sparse"}))
      ->capture_default_str();
  command
      ->add_option("--tiles",
                   options->tiles,
                   "sparse: keep what is far from the drone in this folder when memory is short "
                   "(map.memory_mib); a folder with tiles is gone on with. A map that is larger "
                   "stays there: `map convert DIR` makes one file of it. Damaged tiles are set "
                   "aside as FILE.damaged")
      ->type_name("DIR");
  command->add_option("--frames", options->frames, "use only these frames, both included")
      ->type_name("FIRST:LAST");
  command->add_option("--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace skyhalo::app
