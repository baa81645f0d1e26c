#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "commands.hpp"
#include "common_options.hpp"
#include "sensor_model_output.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo::app {
namespace {

namespace fs = std::filesystem;

/// An option as it was written, so that "" and "none" stay apart.
struct Written {
  std::string text;
  const CLI::Option* option = nullptr;

  [[nodiscard]] bool given() const { return option->count() > 0; }

  [[nodiscard]] std::string name() const { return option->get_name(); }
};

struct SensorModelOptions {
  CommonOptions common;
  std::string figure;
  std::string model;
  Written baseline_m;
  Written focal_px;
  Written delta_theta_u_rad;
  Written delta_d_px;
  Written k;
  Written p_free;
  Written p_unknown;
  Written z;
  Written csv;
  Written svg;
};

UsageError wrong(const Written& written, const std::string& expected) {
  return UsageError(written.name() + " " + written.text + ": expected " + expected);
}

/// The number that was written, or `otherwise`.
std::optional<double> number_of(const Written& written, std::optional<double> otherwise = {}) {
  if (!written.given()) {
    return otherwise;
  }
  const std::optional<double> value = parse_number(written.text);
  if (!value) {
    throw wrong(written, "a number");
  }
  return value;
}

/// The same for a number that the model cannot do without.
double positive(const Written& written, std::optional<double> otherwise) {
  const std::optional<double> value = number_of(written, otherwise);
  if (!value) {
    throw UsageError(written.name() + " is missing (or choose a --figure)");
  }
  if (!(*value > 0.0)) {
    throw wrong(written, "a number above 0");
  }
  return *value;
}

/// What a figure of the thesis is drawn with; without one, what the user left out.
struct Presets {
  std::string_view figure{};
  std::string_view model{};
  std::optional<double> baseline_m{};
  std::optional<double> focal_px{};
  std::optional<double> delta_theta_u_rad{};
  std::string_view z_m = "1,2,5,10";
};

constexpr std::array kPresets{Presets{},
                              Presets{"4.1", "pinhole", 0.1, 250.0, {}, "2,4,6,8,10"},
                              Presets{"4.2", "spherical", 0.1, {}, 0.002, "2,4,6,8,10"},
                              Presets{"6.1", "pinhole", 0.1, 500.0, {}},
                              Presets{"6.2", "spherical", 0.1, {}, 2.5 / 1200.0}};

const Presets& presets_of(const std::string& figure) {
  return *std::find_if(kPresets.begin(), kPresets.end(), [&](const Presets& presets) {
    return presets.figure == figure;
  });
}

PairModel pair_of(const SensorModelOptions& options, const Presets& presets) {
  constexpr double kPrincipalPx = 600.0;  // of figures 4.1 and 4.2; the others do not depend on it
  const std::string model = options.model.empty() ? std::string(presets.model) : options.model;
  if (model.empty()) {
    throw UsageError("--model is missing: pinhole or spherical (or choose a --figure)");
  }
  const bool pinhole = model == "pinhole";
  const Written& foreign = pinhole ? options.delta_theta_u_rad : options.focal_px;
  if (foreign.given()) {
    throw UsageError(foreign.name() + " does not go with --model " + model);
  }
  const double baseline_m = positive(options.baseline_m, presets.baseline_m);
  if (pinhole) {
    return PinholePair{.focal_px = positive(options.focal_px, presets.focal_px),
                       .principal_u_px = kPrincipalPx,
                       .principal_v_px = kPrincipalPx,
                       .baseline_m = baseline_m};
  }
  const double width_rad = positive(options.delta_theta_u_rad, presets.delta_theta_u_rad);
  return SphericalPair{.delta_theta_u_rad = width_rad,
                       .delta_theta_v_rad = width_rad,
                       .principal_u_px = kPrincipalPx,
                       .principal_v_px = kPrincipalPx,
                       .baseline_m = baseline_m};
}

std::vector<double> measurements_of(const Written& written, std::string_view otherwise) {
  constexpr double kFarthestM = 1e6;
  const std::string text = written.given() ? written.text : std::string(otherwise);
  std::vector<double> z_m;
  std::istringstream stream(text + ",");
  for (std::string word; std::getline(stream, word, ',');) {
    const std::optional<double> value = parse_number(word);
    if (!value || !(*value > 0.0) || *value > kFarthestM) {
      throw wrong(written, "ranges in metres above 0, at most 1e6, separated by commas");
    }
    z_m.push_back(*value);
  }
  return z_m;
}

/// The message with the option's name in the place of the key: `--p-free` for
/// `sensor_model.p_free`.
std::string in_options(std::string message) {
  constexpr std::string_view kSection = "sensor_model.";
  if (message.starts_with(kSection)) {
    message.replace(0, kSection.size(), "--");
    std::replace(message.begin(), std::find(message.begin(), message.end(), ':'), '_', '-');
  }
  return message;
}

/// The settings, changed by what was written; outside their domain that is wrong usage.
SensorModelConfig sensor_of(const SensorModelOptions& options, SensorModelConfig config) {
  config.delta_d_px = *number_of(options.delta_d_px, config.delta_d_px);
  config.k = *number_of(options.k, config.k);
  config.p_free = *number_of(options.p_free, config.p_free);
  config.p_unknown = *number_of(options.p_unknown, config.p_unknown);
  try {
    check(config);
  } catch (const Error& error) {
    throw UsageError(in_options(error.what()));
  }
  return config;
}

/// Where to write; none when it was not asked for.
std::optional<fs::path> file_of(const Written& written) {
  if (!written.given()) {
    return std::nullopt;
  }
  fs::path file = written.text;
  if (!file.has_filename()) {
    throw wrong(written, "the name of a file");
  }
  return file;
}

/// Writes what was asked for, and names it in the summary.
void write_files(const SensorModelOptions& options,
                 const SensorModelStudy& study,
                 nlohmann::json& summary) {
  const std::optional<fs::path> csv = file_of(options.csv);
  const std::optional<fs::path> svg = file_of(options.svg);
  if (csv && svg && fs::weakly_canonical(*csv) == fs::weakly_canonical(*svg)) {
    throw UsageError("--csv and --svg name the same file: " + csv->string());
  }
  if (csv) {
    replace_file(*csv, study_csv(study));
    summary["csv"] = csv->string();
  }
  if (svg) {
    replace_file(*svg, study_svg(study));
    summary["svg"] = svg->string();
  }
}

void sensor_model(const SensorModelOptions& options) {
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const Presets& presets = presets_of(options.figure);
  const SensorModelStudy study{.figure = options.figure,
                               .pair = pair_of(options, presets),
                               .config = sensor_of(options, config.detector.sensor_model),
                               .z_m = measurements_of(options.z, presets.z_m),
                               .occupied_probability = config.evaluation.occupied_probability};
  nlohmann::json summary = study_summary(study);
  write_files(options, study, summary);
  std::string text = study_text(study);
  for (const char* kind : {"csv", "svg"}) {
    text += summary.contains(kind) ? "Written: " + summary[kind].get<std::string>() + "\n" : "";
  }
  print_result(options.common, text, summary);
}

void add_written(CLI::App& command, const char* name, Written& written, const char* help) {
  const bool file = name == std::string_view("--csv") || name == std::string_view("--svg");
  written.option = command.add_option(name, written.text, help)->type_name(file ? "FILE" : "X");
}

}  // namespace

void add_sensor_model(CLI::App& program) {
  auto options = std::make_shared<SensorModelOptions>();
  CLI::App* command = program.add_subcommand(
      "sensor-model",
      "the inverse sensor model and the range uncertainty of a stereo pair, in numbers and charts\n"
      "The CSV has the columns z_m,m_m,delta_z_m,p: the probability p that a cell at distance m "
      "is\n"
      "occupied, given the measured range z with uncertainty delta_z. For figures 4.1 and 4.2 it "
      "has\n"
      "u_px,d_px,range_m,delta_x_m,delta_y_m,delta_z_m: the uncertainty of a point on the central\n"
      "row by column.");
  command
      ->add_option("--figure",
                   options->figure,
                   "take the parameters of this figure of the thesis; those given here win")
      ->check(CLI::IsMember({"4.1", "4.2", "6.1", "6.2"}));
  command->add_option("--model", options->model, "kind of rectified pair")
      ->check(CLI::IsMember({"pinhole", "spherical"}));
  add_written(*command, "--baseline-m", options->baseline_m, "distance of the two cameras");
  add_written(*command, "--focal-px", options->focal_px, "pinhole: focal length, as matched");
  add_written(*command,
              "--delta-theta-u-rad",
              options->delta_theta_u_rad,
              "spherical: width of a pixel, as matched");
  add_written(*command,
              "--delta-d-px",
              options->delta_d_px,
              "expected disparity error, as matched (default: sensor_model.delta_d_px, 0.5)");
  add_written(*command, "--k", options->k, "weight of a measurement (default: sensor_model.k)");
  add_written(*command, "--p-free", options->p_free, "p in front (default: sensor_model.p_free)");
  add_written(
      *command, "--p-unknown", options->p_unknown, "p behind (default: sensor_model.p_unknown)");
  add_written(*command,
              "--z",
              options->z,
              "measured ranges in metres (default: 1,2,5,10; figures 4.1, 4.2: 2,4,6,8,10)");
  add_written(*command, "--csv", options->csv, "write the samples here");
  add_written(*command, "--svg", options->svg, "draw two charts here");
  add_common_options(*command, options->common);
  command->callback([options] { sensor_model(*options); });
}

}  // namespace skyhalo::app
