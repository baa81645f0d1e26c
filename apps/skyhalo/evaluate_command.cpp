#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "annotations.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "evaluation_run.hpp"
#include "interrupt.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/base/version.hpp"
#include "skyhalo/dataset/drive_bounds.hpp"
#include "skyhalo/evaluation/comparison_picture.hpp"
#include "skyhalo/evaluation/report.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/picture.hpp"
#include "skyhalo/io/text_file.hpp"
#include "source.hpp"

namespace skyhalo::app {
namespace {

struct EvaluateOptions {
  CommonOptions common;
  SourceOptions source;
  std::string labels;
  std::string bounds;
  double voxel_m = 0.0;  // 0: as configured
  std::string frames;
  std::string out = "out/evaluate";
};

Eigen::AlignedBox3d parse_bounds(const std::string& text) {
  const auto bad = [&] {
    return UsageError("--bounds " + text + ": expected six numbers x0,x1,y0,y1,z0,z1 (m)");
  };
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    const std::optional<double> value = parse_number(word);
    if (!value) {
      throw bad();
    }
    values.push_back(*value);
  }
  if (values.size() != 6 || text.ends_with(',')) {
    throw bad();
  }
  return {Eigen::Vector3d(values[0], values[2], values[4]),
          Eigen::Vector3d(values[1], values[3], values[5])};
}

/// "0003" of label_02_0003.txt or 0003.txt; else the recording's name.
std::string sequence_name(const EvaluateOptions& options,
                          const std::string& label_file,
                          const FrameSource& source) {
  if (!options.source.sequence.empty()) {
    return options.source.sequence;
  }
  const std::string stem = std::filesystem::path(label_file).stem().string();
  const std::string last = stem.substr(stem.find_last_of('_') + 1);
  const bool four_digits =
      last.size() == 4 && last.find_first_not_of("0123456789") == std::string::npos;
  return four_digits ? last : source.name();
}

/// Opens a recording with a laser scanner. `--sequence` chooses among KITTI's sequences; elsewhere
/// it only names the recording in tables.
Recording open_laser_recording(const EvaluateOptions& options, const Config& config) {
  SourceOptions source = options.source;
  if (format_of(source) != SourceFormat::kKittiTracking) {
    source.sequence.clear();
  }
  Recording recording = open_recording(source, options.common, config, Poses::kNeeded);
  if (recording.laser == nullptr) {
    throw input_error(source.path,
                      "is no recording with a laser scanner; expected KITTI's raw data or tracking "
                      "benchmark, or a skyhalo recording with laser/");
  }
  return recording;
}

/// A picture for the page; one that is too large for a page is shrunk.
std::string png_bytes(cv::Mat picture) {
  constexpr int kLargestPx = 4000;
  if (std::max(picture.cols, picture.rows) > kLargestPx) {
    const cv::Size size(std::min(picture.cols, kLargestPx), std::min(picture.rows, kLargestPx));
    cv::resize(picture, picture, size, 0.0, 0.0, cv::INTER_AREA);
  }
  return encode_png(picture);
}

/// Fails where there is nothing to score against.
void check_truth(const Evaluation& evaluation, const FrameRange& range) {
  if (static_cast<int>(evaluation.skipped_scans.size()) > range.last - range.first) {
    throw Error(ErrorKind::kInput, "none of the frames has a laser scan; there is no ground truth");
  }
  const auto observed = evaluation.truth.observed();
  if (std::all_of(observed.begin(), observed.end(), [](std::uint8_t cell) { return cell == 0; })) {
    throw Error(ErrorKind::kInput,
                "no laser ray passes through the map's bounds; there is no ground truth");
  }
}

std::vector<ReportPicture> pictures(const Evaluation& evaluation, double occupied_probability) {
  // About a thousand pixels wide, whatever the map's size.
  const int cell_px = std::clamp(1000 / evaluation.truth.grid().size.head<2>().maxCoeff(), 1, 8);
  const DenseMap& map = evaluation.detector.dense_map();
  return {{"Ground truth from above",
           "Colour: height, dark is low. x (forward) to the right, y up.",
           png_bytes(truth_picture(evaluation.truth, cell_px))},
          {"Map from above",
           "Occupied cells by height; white: seen free; pale blue: never seen.",
           png_bytes(top_picture(map, occupied_probability, cell_px))},
          {"Map against ground truth",
           "Columns with a cell that is found (green), only claimed (orange), only missed (blue).",
           png_bytes(comparison_picture(map, evaluation.truth, occupied_probability, cell_px))}};
}

void write_files(const OutputFolder& out,
                 const Evaluation& evaluation,
                 const EvaluationResult& result,
                 double occupied_probability) {
  write_bytes(out.file("metrics.csv"), metrics_csv(result));
  write_bytes(out.file("table.md"), metrics_table(result));
  write_bytes(out.file("report.html"), metrics_report(result));
  write_bytes(out.file("summary.json"), metrics_summary(result).dump(2) + "\n");
  write_ply(out.file("ground_truth.ply"),
            cell_points(evaluation.truth.grid(), evaluation.truth.occupied_offsets()));
  write_ply(out.file("map.ply"),
            occupied_points(evaluation.detector.dense_map(), occupied_probability));
}

void note_skipped(const CommonOptions& common, const std::vector<int>& frames) {
  if (frames.empty()) {
    return;
  }
  std::string list;
  for (const int frame : frames) {
    list += (list.empty() ? "" : ", ") + std::to_string(frame);
  }
  print_note(common, "laser scans missing and skipped: frame " + list);
}

void evaluate(const EvaluateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Config config = load_config(options.common);
  config.detector.map.voxel_m =
      options.voxel_m > 0.0 ? options.voxel_m : config.detector.map.voxel_m;
  const ThreadLimit limit(options.common.threads);
  const Recording recording = open_laser_recording(options, config);
  const FrameSource& drive = *recording.frames;
  const Annotations annotations = find_annotations(recording, options.labels, config.evaluation);
  const FrameRange range = parse_frames(options.frames, drive.frame_count());
  const Eigen::AlignedBox3d bounds =
      options.bounds.empty() ? drive_bounds(drive, config.bounds) : parse_bounds(options.bounds);
  const VoxelGrid grid = make_voxel_grid(bounds, config.detector.map.voxel_m);
  OutputFolder out(options.out);

  Evaluation evaluation{GroundTruth(grid), ObstacleDetector(drive.rig(), config.detector, grid)};
  build_truth(recording,
              annotations.boxes_of,
              config.evaluation,
              {range, options.common.quiet},
              evaluation);
  check_truth(evaluation, range);
  map_and_score(drive, config.evaluation, {range, options.common.quiet}, evaluation);

  EvaluationResult result{
      .version = kVersion,
      .sequence = sequence_name(options, annotations.file, drive),
      .source = drive.name(),
      .grid = grid,
      .max_range_m = config.evaluation.max_range_m,
      .occupied_cells = static_cast<std::int64_t>(evaluation.truth.occupied_offsets().size()),
      .skipped_scans = evaluation.skipped_scans,
      .rows = evaluation.rows,
      .stages = evaluation.clock.times(),
      .pictures = pictures(evaluation, config.evaluation.occupied_probability),
      .labelled = annotations.known,
      .duration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
      .config_yaml = to_yaml(config)};
  write_files(out, evaluation, result, config.evaluation.occupied_probability);
  stop_if_interrupted();
  out.commit();
  if (options.labels.empty()) {
    print_note(options.common, "no --labels: what moves is taken for ground truth too");
  }
  note_skipped(options.common, evaluation.skipped_scans);
  print_result(
      options.common,
      metrics_table(result) + "\nWritten to " + options.out +
          ": metrics.csv, table.md, report.html, ground_truth.ply, map.ply, summary.json\n",
      metrics_summary(result));
}

}  // namespace

void add_evaluate(CLI::App& program) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = program.add_subcommand(
      "evaluate",
      "score the map of a recording against ground truth from its laser scanner, frame by frame\n"
      "writes metrics.csv, table.md, report.html, ground_truth.ply, map.ply and summary.json");
  add_source_options(*command, options->source);
  command
      ->add_option("--labels",
                   options->labels,
                   "KITTI tracking labels; laser points in their boxes are no ground truth\n"
                   "(default: those of the KITTI sequence, the objects of a skyhalo recording)")
      ->type_name("FILE");
  command->get_option("--sequence")
      ->description(
          "sequence of a KITTI tracking folder (default: the only one); else the name in tables "
          "(default: from the label file)");
  command
      ->add_option(
          "--bounds", options->bounds, "of the map, in the map frame (default: follows the drive)")
      ->type_name("x0,x1,y0,y1,z0,z1");
  command
      ->add_option(
          "--voxel", options->voxel_m, "edge of a map cell in metres (default: map.voxel_m)")
      ->type_name("M")
      ->check(CLI::PositiveNumber);
  command->add_option("--frames", options->frames, "use only these frames, both included")
      ->type_name("FIRST:LAST");
  command->add_option("--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { evaluate(*options); });
}

}  // namespace skyhalo::app
