#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "common_options.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "rectified_pair_files.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/io/disparity_image.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/picture.hpp"
#include "skyhalo/stereo/matcher.hpp"

namespace skyhalo::app {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestRangePx = 256;  // in the matched image

struct DisparityCommand {
  CommonOptions common;
  std::string left;
  std::string right;
  std::string out;
  std::string picture;
  std::optional<int> max_disparity_px;
  std::string align = "right";
  std::string matcher;
  int downscale = 1;
  int repeat = 1;
};

// --- what is asked for ---

/// The option's file; it must be called .png, as that is what is written.
fs::path png_file(const char* option, const std::string& name) {
  fs::path file = name;
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (ending != ".png") {
    throw UsageError(std::string(option) + " " + name + ": expected the name of a .png file");
  }
  return file;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored) ||
         fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

/// The files to write: the disparities and, if asked for, their picture.
struct Outputs {
  fs::path disparities;
  std::optional<fs::path> picture;
};

Outputs outputs_of(const DisparityCommand& options) {
  Outputs outputs{.disparities = png_file("--out", options.out), .picture = {}};
  if (!options.picture.empty()) {
    outputs.picture = png_file("--picture", options.picture);
    if (same_file(*outputs.picture, outputs.disparities)) {
      throw UsageError("--out and --picture name the same file: " + options.out);
    }
  }
  for (const std::string& input : {options.left, options.right}) {
    if (same_file(outputs.disparities, input) ||
        (outputs.picture && same_file(*outputs.picture, input))) {
      throw UsageError(input + ": is an input image, it would be overwritten");
    }
  }
  return outputs;
}

/// Finds out before the work what could not be written after it.
void refuse_missing_folder(const fs::path& file) {
  const fs::path folder = file.parent_path();
  std::error_code ignored;
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    throw Error(ErrorKind::kFailure,
                file.string() + ": cannot be written (there is no folder " + folder.string() + ")");
  }
}

/// The settings, changed by what was written. Their search range counts pixels of the input.
MatcherConfig matcher_of(const DisparityCommand& options, MatcherConfig config) {
  const int wanted_px = options.max_disparity_px.value_or(config.max_disparity_px);
  const int largest_px = kLargestRangePx * options.downscale;
  if (wanted_px > largest_px) {
    throw UsageError("--max-disparity " + std::to_string(wanted_px) + ": expected at most " +
                     std::to_string(largest_px) + " with --downscale " +
                     std::to_string(options.downscale));
  }
  const int step_px = kSearchStepPx * options.downscale;
  config.max_disparity_px = (wanted_px + step_px - 1) / step_px * kSearchStepPx;
  config.alignment = options.align == "left" ? Alignment::kLeft : Alignment::kRight;
  if (!options.matcher.empty()) {
    config.kind = options.matcher == "sgm" ? MatcherKind::kSgm : MatcherKind::kOpencv;
  }
  return config;
}

// --- the work ---

/// The middle value, or the mean of the two in the middle.
double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

double timed_match_ms(Matcher& matcher, const StereoImages& pair, cv::Mat1f& disparity) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  matcher.match(pair.left, pair.right, disparity);
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Matches and returns the median time of `--repeat` times. With more than one, a match before them
/// makes the memory and is not counted.
double match_ms(const DisparityCommand& options,
                Matcher& matcher,
                const StereoImages& pair,
                cv::Mat1f& disparity) {
  constexpr double kLongMs = 2000.0;
  const double first_ms = timed_match_ms(matcher, pair, disparity);
  stop_if_interrupted();
  if (options.repeat == 1) {
    return first_ms;
  }
  std::vector<double> times_ms;
  const bool is_long = first_ms * options.repeat > kLongMs;
  ProgressBar bar("matching", options.repeat, options.common.quiet || !is_long);
  for (int i = 0; i < options.repeat; ++i) {
    times_ms.push_back(timed_match_ms(matcher, pair, disparity));
    stop_if_interrupted();
    bar.advance();
  }
  return median(std::move(times_ms));
}

void warn_of_clipping(const CommonOptions& options, const cv::Mat1f& disparity) {
  if (const int clipped = clipped_count(disparity); clipped > 0) {
    print_warnings(options,
                   {std::to_string(clipped) +
                    " disparities of 256 px or more are written as 65535, the largest number"});
  }
}

/// Writes what was asked for; nothing if one of the images cannot be encoded.
void write_files(const Outputs& outputs, const cv::Mat1f& disparity, const cv::Mat1w& image) {
  const std::string disparities = encode_png(image);
  if (outputs.picture) {
    replace_file(*outputs.picture, encode_png(disparity_picture(disparity)));
  }
  replace_file(outputs.disparities, disparities);
}

std::string describe(const nlohmann::json& summary) {
  std::ostringstream text;
  text << summary["size_px"][0] << " x " << summary["size_px"][1] << " pixels matched by "
       << summary["matcher"].get<std::string>() << ", disparities below "
       << summary["max_disparity_px"] << " px, aligned with the "
       << summary["align"].get<std::string>() << " image";
  if (summary["downscale"] > 1) {
    text << ", shrunk by " << summary["downscale"];
  }
  text << "\n"
       << std::fixed << std::setprecision(1) << 100.0 * summary["density"].get<double>()
       << " % of the pixels have a disparity; " << std::setprecision(2)
       << summary["match_ms"].get<double>() << " ms a match";
  if (summary["repeat"] > 1) {
    text << " (median of " << summary["repeat"] << ")";
  }
  text << "\nWritten: " << summary["out"].get<std::string>();
  if (summary.contains("picture")) {
    text << ", " << summary["picture"].get<std::string>();
  }
  return text.str() + "\n";
}

void disparity(const DisparityCommand& options) {
  const Outputs outputs = outputs_of(options);
  const Config config = load_config(options.common);
  const MatcherConfig settings = matcher_of(options, config.detector.matching.matcher);
  const ThreadLimit limit(options.common.threads);
  const StereoImages pair = read_rectified_pair(options.left, options.right);
  const cv::Size size = pair.left.size();
  const int factor = options.downscale;
  check_room(options.left, size, {factor, settings.max_disparity_px});
  refuse_missing_folder(outputs.disparities);
  refuse_missing_folder(outputs.picture.value_or(outputs.disparities));

  Matcher matcher(settings);
  cv::Mat1f matched;
  const double time_ms = match_ms(options, matcher, shrunk_grey(pair, factor), matched);
  const cv::Mat1f disparity_px = enlarged_disparity(matched, factor, size);
  const cv::Mat1w image = disparity_image(disparity_px);
  nlohmann::json summary = {
      {"matcher", settings.kind == MatcherKind::kSgm ? "sgm" : "opencv"},
      {"size_px", {size.width, size.height}},
      {"max_disparity_px", settings.max_disparity_px * factor},
      {"downscale", factor},
      {"align", options.align},
      {"threads", tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)},
      {"repeat", options.repeat},
      {"match_ms", time_ms},
      {"density",
       static_cast<double>(cv::countNonZero(image)) / static_cast<double>(image.total())},
      {"out", options.out}};
  write_files(outputs, disparity_px, image);
  warn_of_clipping(options.common, disparity_px);
  if (outputs.picture) {
    summary["picture"] = options.picture;
  }
  print_result(options.common, describe(summary), summary);
}

void add_matching_options(CLI::App& command, DisparityCommand& options) {
  constexpr int kLargestFactor = 16;
  command
      .add_option("--max-disparity",
                  options.max_disparity_px,
                  "find disparities below this, 1...256 S px of the input; divided by the\n"
                  "downscale S it is rounded up to a multiple of 16\n"
                  "(default: matching.max_disparity_px, 64)")
      ->type_name("N")
      ->check(CLI::Range(1, kLargestRangePx * kLargestFactor));
  command
      .add_option("--downscale",
                  options.downscale,
                  "match images shrunk by this whole factor, for speed or for large disparities")
      ->type_name("S")
      ->check(CLI::Range(1, kLargestFactor))
      ->capture_default_str();
  command
      .add_option("--align",
                  options.align,
                  "which image's pixels get the disparities: right pixel (u, v) matches left\n"
                  "(u + d, v), left pixel (u, v) matches right (u - d, v)")
      ->check(CLI::IsMember({"right", "left"}))
      ->capture_default_str();
  command.add_option("--matcher", options.matcher, "the engine (default: matching.matcher, sgm)")
      ->check(CLI::IsMember({"sgm", "opencv"}));
  command
      .add_option("--repeat",
                  options.repeat,
                  "match_ms is the median of so many matches; above 1, one before them does\n"
                  "not count")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
}

}  // namespace

void add_disparity(CLI::App& program) {
  auto options = std::make_shared<DisparityCommand>();
  CLI::App* command = program.add_subcommand(
      "disparity",
      "the disparities of one rectified pair, as a 16-bit PNG\n"
      "A pixel is 256 times its disparity in pixels of the input; 0 is none. A disparity of 0 is\n"
      "written as 1, one of 256 px or more as 65535. With --downscale each matched pixel fills\n"
      "its block; rows and columns beyond the last whole block have none.\n"
      "Settings: matching.matcher, matching.max_disparity_px (here in pixels of the input), sgm.*\n"
      "and opencv.*; matching.downscale, rcrop_px and masks_px are not used.");
  command
      ->add_option("LEFT",
                   options->left,
                   "left image, rectified: 8 or 16 bits, grey or colour, as the right one")
      ->required();
  command->add_option("RIGHT", options->right, "right image")->required();
  command->add_option("-o,--out", options->out, "where to write the disparities (.png)")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--picture",
                   options->picture,
                   "write them for the eye too: yellow is near, blue is far, black is none (.png)")
      ->type_name("FILE");
  add_matching_options(*command, *options);
  add_common_options(*command, options->common);
  command->callback([options] { disparity(*options); });
}

}  // namespace skyhalo::app
