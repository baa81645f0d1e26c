#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>

#include "commands.hpp"
#include "common_options.hpp"
#include "for_each_frame.hpp"
#include "skyhalo/dataset/drive_bounds.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/trajectory_file.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "source.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {
namespace {

struct RunOptions {
  CommonOptions common;
  SourceOptions source;
  std::string map = "global";
  std::string frames;
  std::string out = "out/run";
};

/// What a run leaves behind besides the map.
struct RunRecord {
  std::vector<StampedPose> trajectory;
  double duration_s = 0.0;
};

RunRecord run_frames(const FrameSource& source,
                     FrameRange range,
                     ObstacleDetector& detector,
                     ProgressBar& bar,
                     StageClock& clock) {
  RunRecord record;
  const auto start = std::chrono::steady_clock::now();
  for_each_frame(
      range,
      bar,
      [&](int frame) { return source.read(frame); },
      [&](int frame, const FrameSet& frames) {
        const Pose T_map_body = source.T_map_body(frame);
        detector.process(frames, T_map_body, &clock);
        record.trajectory.push_back({frames.stamp, T_map_body});
      });
  record.duration_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return record;
}

std::string describe(const nlohmann::json& summary, const std::vector<StageTimes>& stages) {
  std::ostringstream text;
  text << summary["frames"] << " frames, " << summary["dropped"] << " dropped, "
       << summary["frames_per_second"].get<double>() << " frames per second\n\n"
       << "| stage | p50 ms | p95 ms |\n|---|---|---|\n";
  for (const StageTimes& stage : stages) {
    text << "| " << stage.stage << " | " << stage.p50_ms << " | " << stage.p95_ms << " |\n";
  }
  text << "\nWritten to " << summary["out"].get<std::string>()
       << ": summary.json, map.ply, map.ot, trajectory.tum\n";
  return text.str();
}

void run(const RunOptions& options) {
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const auto source = open_recording(options.source, options.common, config, Poses::kNeeded).frames;
  const FrameRange range = parse_frames(options.frames, source->frame_count());
  OutputFolder out(options.out);
  ObstacleDetector detector(
      source->rig(),
      config.detector,
      make_voxel_grid(drive_bounds(*source, config.bounds), config.detector.map.voxel_m));
  StageClock clock;
  RunRecord record;
  {
    ProgressBar bar("mapping", range.last - range.first + 1, options.common.quiet);
    record = run_frames(*source, range, detector, bar, clock);
  }
  const auto frames = static_cast<double>(record.trajectory.size());
  const nlohmann::json summary = {
      {"source", source->name()},
      {"map", options.map},
      {"frames", record.trajectory.size()},
      {"dropped", range.last - range.first + 1 - static_cast<int>(record.trajectory.size())},
      {"seconds", record.duration_s},
      {"frames_per_second", frames / record.duration_s},
      {"stages", stages_json(clock.times())},
      {"out", options.out}};
  write_ply(out.file("map.ply"),
            occupied_points(detector.map(), config.evaluation.occupied_probability));
  write_octree(out.file("map.ot"), detector.map());
  write_tum(out.file("trajectory.tum"), record.trajectory);
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  stop_if_interrupted();
  out.commit();
  print_result(options.common, describe(summary, clock.times()), summary);
}

}  // namespace

void add_run(CLI::App& program) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand(
      "run",
      "detection and mapping over a recording\n"
      "writes summary.json, map.ply (occupied cells), map.ot (OctoMap) and trajectory.tum");
  add_source_options(*command, options->source);
  add_rig_option(*command, options->source);
  command
      ->add_option("--map", options->map, "kind of map: global (fixed bounds, follows the drive)")
      ->check(CLI::IsMember({"global"}))
      ->capture_default_str();
  command->add_option("--frames", options->frames, "use only these frames, both included")
      ->type_name("FIRST:LAST");
  command->add_option("--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace skyhalo::app
