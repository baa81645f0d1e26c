#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "common_options.hpp"
#include "halo_output.hpp"
#include "halo_run.hpp"
#include "interrupt.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "source.hpp"

namespace skyhalo::app {
namespace {

struct HaloCommand {
  CommonOptions common;
  SourceOptions source;
  std::string frames;
  std::string picture_frames;
  int picture_every = 0;  // 0: none
  double cone_deg = 20.0;
  bool laser = false;
  std::string out = "out/halo";
};

/// Reads `N,N,...`, frames of the range.
std::vector<int> parse_picture_frames(const std::string& text, const FrameRange& range) {
  std::vector<int> frames;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    const std::optional<int> frame = parse_whole_number(word);
    if (!frame || *frame < range.first || *frame > range.last) {
      throw UsageError("--picture-frames " + text + ": expected numbers N,N,... of the frames " +
                       std::to_string(range.first) + ":" + std::to_string(range.last));
    }
    frames.push_back(*frame);
  }
  return frames;
}

/// Of which frames there are to be pictures.
std::set<int> picture_frames(const HaloCommand& options, const FrameRange& range) {
  const std::vector<int> listed = parse_picture_frames(options.picture_frames, range);
  std::set<int> frames(listed.begin(), listed.end());
  for (int frame = range.first; options.picture_every > 0 && frame <= range.last;
       frame += options.picture_every) {
    frames.insert(frame);
  }
  return frames;
}

/// Pictures of an earlier run that this one would not replace must not stand among its own.
void refuse_other_pictures(const std::string& folder, const std::set<int>& frames) {
  if (!std::filesystem::is_directory(folder)) {
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::optional<int> frame =
        name.starts_with("frame_") && name.ends_with(".png")
            ? parse_whole_number(std::string_view(name).substr(6, name.size() - 10))
            : std::nullopt;
    if (frame && !frames.contains(*frame)) {
      std::string message = "--out " + folder + ": holds ";
      message += name + " of an earlier run; remove it or choose another folder";
      throw UsageError(message);
    }
  }
}

/// The recording's laser, if it is to be asked.
const LaserSource* laser_of(const HaloCommand& options, const Recording& recording) {
  if (options.laser && recording.laser == nullptr) {
    throw input_error(options.source.path,
                      "has no laser scanner to compare with; expected a KITTI drive or sequence "
                      "with Velodyne scans or a skyhalo recording with laser/, or no --laser");
  }
  return options.laser ? recording.laser : nullptr;
}

bool has_poses(const Recording& recording) {
  const auto* const flight = dynamic_cast<const EurocFlight*>(recording.frames.get());
  return recording.T_body_imu.has_value() && (flight == nullptr || flight->has_poses());
}

void note_without(const HaloCommand& options, const std::string& what, const std::vector<int>& in) {
  std::string list;
  for (const int frame : in) {
    list += (list.empty() ? "" : ", ") + std::to_string(frame);
  }
  if (!in.empty()) {
    print_note(options.common, what + ", not compared: frame " + list);
  }
}

HaloSettings settings_of(const HaloCommand& options,
                         const Config& config,
                         const Recording& recording) {
  const FrameSource& source = *recording.frames;
  const FrameRange range = parse_frames(options.frames, source.frame_count());
  if (!(options.cone_deg > 0.0 && options.cone_deg <= 180.0)) {
    throw UsageError("--cone-deg: expected degrees above 0, at most 180");
  }
  HaloSettings settings{.range = range,
                        .check = {},
                        .laser = laser_of(options, recording),
                        .has_poses = has_poses(recording),
                        .picture_frames = picture_frames(options, range),
                        .quiet = options.common.quiet};
  refuse_other_pictures(options.out, settings.picture_frames);
  settings.check.half_angle_rad = rad_from_deg(options.cone_deg);
  settings.check.max_range_m =
      source.rig().pairs.front().max_range_m.value_or(config.detector.sphere.max_range_m);
  return settings;
}

void halo(const HaloCommand& options) {
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const Recording recording =
      open_recording(options.source, options.common, config, Poses::kUnused);
  HaloRun run(*recording.frames, config, settings_of(options, config, recording));
  OutputFolder out(options.out);
  run.process(out);
  if (options.laser && run.without_scan().size() == run.rows().size()) {
    throw input_error(
        options.source.path,
        "none of the frames has a laser scan (velodyne_points/data); there is nothing "
        "to compare with");
  }
  nlohmann::json summary = halo_summary(run);
  summary["source"] = recording.frames->name();
  summary["out"] = options.out;
  write_bytes(out.file("halo.csv"), halo_csv(run));
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  stop_if_interrupted();
  out.commit();
  note_without(options, "laser scans missing", run.without_scan());
  note_without(options, "no road in the laser scan", run.without_road());
  print_result(options.common, describe_halo(summary), summary);
}

}  // namespace

void add_halo(CLI::App& program) {
  auto options = std::make_shared<HaloCommand>();
  CLI::App* command = program.add_subcommand(
      "halo",
      "the nearest distances in all directions of each frame, in numbers and pictures\n"
      "writes summary.json, frame_NNNNNN.png for the frames asked for (right image, disparities,\n"
      "the halo unrolled and from above) and halo.csv, with a line for each frame:\n"
      "  obstacle_cells, free_cells, unseen_cells   of the whole sphere\n"
      "  forward_nearest_m                          in the cone ahead; empty for none\n"
      "  nearest_m, azimuth_deg, pitch_deg          in all directions; left and up are positive\n"
      "  forward_limit_mps, reason                  how fast one may set off level ahead, at most\n"
      "                                             20 m/s, and what forbids more (safety.*)\n"
      "With --laser also, of things in the cone more than 0.2 m above the road (a plane fitted to\n"
      "the scan):\n"
      "  laser_nearest_m, stereo_nearest_m          the nearest, from the body\n"
      "  agrees                                     1 when within 0.5 m or 10 % of the laser's\n"
      "  laser_supported_m, supported_agrees        with the nearest laser point that has two\n"
      "                                             more within 0.5 m");
  add_source_options(*command, options->source);
  add_rig_option(*command, options->source);
  command->add_option("--frames", options->frames, "use only these frames, both included")
      ->type_name("FIRST:LAST");
  CLI::Option* const frames =
      command->add_option("--picture-frames", options->picture_frames, "make pictures of these")
          ->type_name("N,N,...");
  command
      ->add_option("--picture-every", options->picture_every, "make a picture of each N-th frame")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->excludes(frames);
  command
      ->add_option(
          "--cone-deg",
          options->cone_deg,
          "half of the opening angle of the cone ahead (body x axis), above 0, at most 180")
      ->type_name("DEG")
      ->capture_default_str();
  command->add_flag(
      "--laser", options->laser, "compare with the recording's laser scanner (not EuRoC flights)");
  command->add_option("-o,--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { halo(*options); });
}

}  // namespace skyhalo::app
