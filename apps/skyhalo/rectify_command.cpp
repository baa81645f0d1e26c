#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "commands.hpp"
#include "common_options.hpp"
#include "for_each_frame.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/camera/shrunk_camera.hpp"
#include "skyhalo/dataset/image_pair.hpp"
#include "skyhalo/evaluation/row_difference.hpp"
#include "skyhalo/io/epipolar_picture.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "source.hpp"

namespace skyhalo::app {
namespace {

struct RectifyCommand {
  CommonOptions common;
  std::vector<std::string> inputs;
  SourceOptions source;
  std::string pair;
  std::string frames;
  std::string out = "out/rectify";
  int downscale = 1;
  bool skip_row_check = false;
};

/// One frame's rectified images and how level they are.
struct RectifiedFrame {
  int frame = 0;
  RowDifference rows;
};

std::size_t find_pair(const StereoRig& rig, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < rig.pairs.size(); ++i) {
    if (name == rig.pairs[i].name || (name.empty() && rig.pairs.size() == 1)) {
      return i;
    }
    known += " " + rig.pairs[i].name;
  }
  throw UsageError((name.empty() ? "--pair: expected one of" : "--pair " + name + ": the rig has") +
                   known);
}

/// A recording as it is, or two image files as one of a single frame.
Recording open_images(const RectifyCommand& options, const Config& config) {
  if (options.inputs.size() == 1) {
    SourceOptions source = options.source;
    source.path = options.inputs.front();
    return open_recording(source, options.common, config, Poses::kUnused);
  }
  if (options.source.rig.empty()) {
    throw UsageError("--rig: expected the rig file of the cameras that took the two images");
  }
  const OpenedRig opened = open_rig(options.source.rig, options.common, config);
  Recording recording;
  recording.frames = std::make_unique<ImagePairSource>(
      options.inputs[0], options.inputs[1], opened.rig.pairs[find_pair(opened.rig, options.pair)]);
  recording.T_body_imu = opened.T_body_imu;
  return recording;
}

/// The rectified pair as a rig file of its own, for whoever goes on with the images.
RigDescription describe_output(const StereoPair& pair,
                               const std::optional<Pose>& T_body_imu,
                               int factor) {
  PairDescription output{.name = pair.name,
                         .images = RectifiedPairDescription{{pair.image_size_px.width / factor,
                                                             pair.image_size_px.height / factor},
                                                            downscaled(pair.model, factor)},
                         .T_body_camera = pair.T_body_camera,
                         .rcrop_px = pair.rcrop_px,
                         .min_range_m = pair.min_range_m,
                         .max_range_m = pair.max_range_m};
  if (pair.downscale && *pair.downscale % factor == 0) {
    output.downscale = *pair.downscale / factor;
  }
  for (const cv::Rect& mask : pair.masks_px) {
    output.masks_px.push_back(skyhalo::downscaled(mask, factor));
  }
  return {.name = pair.name + " rectified", .T_body_imu = T_body_imu, .pairs = {output}};
}

std::string frame_name(const char* side, int frame) {
  std::array<char, 48> name{};
  const int length = std::snprintf(name.data(), name.size(), "%s_%06d.png", side, frame);
  return {name.data(), static_cast<std::size_t>(length)};
}

/// Frames of an earlier run that this one would not replace must not stand among its own.
void refuse_other_frames(const std::filesystem::path& folder, const FrameRange& range) {
  if (!std::filesystem::is_directory(folder)) {
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::optional<int> frame =
        name.starts_with("left_") && name.ends_with(".png")
            ? parse_whole_number(std::string_view(name).substr(5, name.size() - 9))
            : std::nullopt;
    if (frame && (*frame < range.first || *frame > range.last)) {
      throw UsageError("--out " + folder.string() + ": holds " + name +
                       " of an earlier run; remove it or choose another folder");
    }
  }
}

double median(std::vector<double> values) {
  if (values.empty()) {
    return std::nan("");
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Rectifies, measures and writes the frames, one after the other.
class FrameWriter {
 public:
  FrameWriter(const StereoPair& pair, const RectifyCommand& options, const OutputFolder& out)
      : rectifier_(pair, options.downscale), options_(options), out_(out) {}

  void write(int frame, const StereoImages& images) {
    const RectifiedPair& pair = rectifier_.rectify(images);
    RectifiedFrame done{.frame = frame, .rows = {}};
    if (!options_.skip_row_check) {
      done.rows = row_difference(pair.left, pair.right, pair.left_valid, pair.right_valid);
    }
    if (frames_.empty()) {
      write_first(pair, done.rows);
    }
    write_png(out_.file(frame_name("left", frame)), pair.left);
    write_png(out_.file(frame_name("right", frame)), pair.right);
    frames_.push_back(std::move(done));
  }

  [[nodiscard]] const std::vector<RectifiedFrame>& frames() const noexcept { return frames_; }

 private:
  void write_first(const RectifiedPair& pair, const RowDifference& rows) const {
    const int step_px = std::max(16, pair.left.rows / 16);
    write_png(out_.file("side_by_side.png"),
              epipolar_picture(pair.left, pair.right, step_px, rows.inliers));
    if (!pair.left_valid.empty()) {
      write_png(out_.file("left_valid.png"), pair.left_valid);
      write_png(out_.file("right_valid.png"), pair.right_valid);
    }
  }

  Rectifier rectifier_;
  const RectifyCommand& options_;
  const OutputFolder& out_;
  std::vector<RectifiedFrame> frames_;
};

std::string rows_csv(const std::vector<RectifiedFrame>& frames) {
  std::ostringstream csv;
  csv << "frame,matches,median_abs_dv_px,p90_abs_dv_px,median_dv_px,median_disparity_px,"
         "negative_disparity_share\n";
  for (const auto& [frame, rows] : frames) {
    csv << frame << "," << rows.matches << "," << rows.median_abs_dv_px << "," << rows.p90_abs_dv_px
        << "," << rows.median_dv_px << "," << rows.median_disparity_px << ","
        << rows.negative_disparity_share << "\n";
  }
  return csv.str();
}

/// Over the matches of all frames together, and the worst of the frames' medians; nulls where no
/// feature was matched.
nlohmann::json rows_json(const std::vector<RectifiedFrame>& frames) {
  std::vector<double> abs_dv_px;
  double worst_px = std::nan("");
  int negative = 0;
  for (const auto& [frame, rows] : frames) {
    for (const PairMatch& match : rows.inliers) {
      abs_dv_px.push_back(std::abs(match.dv_px));
      negative += match.disparity_px < -1.0 ? 1 : 0;
    }
    worst_px = std::fmax(worst_px, rows.median_abs_dv_px);
  }
  const std::size_t matches = abs_dv_px.size();
  return {
      {"matches", matches},
      {"median_abs_dv_px", median(std::move(abs_dv_px))},
      {"worst_frame_median_abs_dv_px", worst_px},
      {"negative_disparity_share", static_cast<double>(negative) / static_cast<double>(matches)}};
}

/// What the measurement says against the calibration, if anything.
std::vector<std::string> doubts(const nlohmann::json& rows) {
  std::vector<std::string> found;
  if (rows["matches"] == 0) {
    found.emplace_back("no feature was matched: the rows were not measured");
    return found;
  }
  if (rows["negative_disparity_share"] > 0.5) {
    found.emplace_back("most disparities are negative: left and right images look swapped");
  }
  if (rows["median_abs_dv_px"] > 1.0) {
    found.emplace_back(
        "the rows differ by more than a pixel: the calibration does not fit these images");
  }
  return found;
}

std::string describe(const nlohmann::json& summary) {
  std::ostringstream text;
  text << summary["frames"] << (summary["frames"] == 1 ? " frame" : " frames") << " of pair "
       << summary["pair"].get<std::string>() << " rectified to " << summary["size_px"][0] << " x "
       << summary["size_px"][1] << "\n";
  if (summary.contains("rows") && summary["rows"]["matches"] > 0) {
    const nlohmann::json& rows = summary["rows"];
    text << std::setprecision(3) << "rows differ by " << rows["median_abs_dv_px"].get<double>()
         << " px in the median of " << rows["matches"] << " matched features (worst frame "
         << rows["worst_frame_median_abs_dv_px"].get<double>() << " px)\n";
  }
  text << "Written to " << summary["out"].get<std::string>()
       << ": left_*.png, right_*.png, side_by_side.png, rig.yaml, summary.json\n";
  return text.str();
}

void rectify(const RectifyCommand& options) {
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const Recording recording = open_images(options, config);
  const auto& source = recording.frames;
  const std::size_t index = options.inputs.size() == 2 ? 0 : find_pair(source->rig(), options.pair);
  const StereoPair& pair = source->rig().pairs[index];
  const FrameRange range = parse_frames(options.frames, source->frame_count());
  refuse_other_frames(options.out, range);
  OutputFolder out(options.out);
  FrameWriter writer(pair, options, out);
  {
    ProgressBar bar("rectifying", range.last - range.first + 1, options.common.quiet);
    for_each_frame(
        range,
        bar,
        [&](int frame) { return source->read(frame); },
        [&](int frame, const FrameSet& frames) { writer.write(frame, frames.pairs[index]); });
  }
  const RigDescription output = describe_output(pair, recording.T_body_imu, options.downscale);
  const cv::Size size = std::get<RectifiedPairDescription>(output.pairs.front().images).size_px;
  nlohmann::json summary = {{"source", source->name()},
                            {"pair", pair.name},
                            {"frames", writer.frames().size()},
                            {"size_px", {size.width, size.height}},
                            {"baseline_m", baseline_m(pair.model)},
                            {"out", options.out}};
  if (!options.skip_row_check) {
    summary["rows"] = rows_json(writer.frames());
    print_warnings(options.common, doubts(summary["rows"]));
    write_bytes(out.file("rows.csv"), rows_csv(writer.frames()));
  }
  write_bytes(out.file("rig.yaml"), to_yaml(output, "The images beside this file."));
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  stop_if_interrupted();
  out.commit();
  print_result(options.common, describe(summary), summary);
}

}  // namespace

void add_rectify(CLI::App& program) {
  auto options = std::make_shared<RectifyCommand>();
  CLI::App* command = program.add_subcommand(
      "rectify",
      "raw images to the virtual pair, and how level its rows are\n"
      "writes left_*.png, right_*.png, side_by_side.png (with epipolar lines), *_valid.png,\n"
      "rows.csv (row differences of matched features), rig.yaml (of the result), summary.json");
  command
      ->add_option("INPUT",
                   options->inputs,
                   "a recording (KITTI, EuRoC or skyhalo's own), or a left and a right image")
      ->required()
      ->expected(1, 2)
      ->type_name("SOURCE | LEFT RIGHT");
  add_rig_option(*command, options->source);
  add_format_options(*command, options->source);
  command->add_option(
      "--pair", options->pair, "name of the pair in the rig (default: the only one)");
  command->add_option("--frames", options->frames, "use only these frames, both included")
      ->type_name("FIRST:LAST");
  command->add_option("--downscale", options->downscale, "shrink the result by this whole factor")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command->add_flag(
      "--skip-row-check", options->skip_row_check, "do not match features to measure the rows");
  command->add_option("-o,--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { rectify(*options); });
}

}  // namespace skyhalo::app
