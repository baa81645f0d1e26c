#include <chrono>
#include <memory>
#include <sstream>

#include "commands.hpp"
#include "common_options.hpp"
#include "flight_export.hpp"
#include "simulation.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "source.hpp"

namespace skyhalo::app {
namespace {

struct SimulateOptions {
  CommonOptions common;
  SimulationOptions simulation;
  std::string rig;
  std::string pair;
  std::string format = "skyhalo";
  std::optional<int> sequence{};
  bool without_truth = false;
  bool without_laser = false;
  std::string out = "out/simulate";
};

ExportFormat format_of(const std::string& name) {
  if (name == "kitti-tracking") {
    return ExportFormat::kKittiTracking;
  }
  return name == "euroc" ? ExportFormat::kEuroc : ExportFormat::kSkyhalo;
}

/// KITTI's tracking layout has no time stamps: its frames are 0.1 s apart.
SimulationOptions wish_for(ExportFormat format, SimulationOptions wish) {
  constexpr double kKittiHz = 10.0;
  if (format != ExportFormat::kKittiTracking) {
    return wish;
  }
  if (wish.rate_hz != 0.0 && wish.rate_hz != kKittiHz) {
    throw UsageError("--rate: frames in KITTI's tracking layout are 0.1 s apart, so 10 Hz");
  }
  wish.rate_hz = kKittiHz;
  return wish;
}

/// Throws for options that mean nothing in the format.
void check_options(ExportFormat format, const SimulateOptions& options) {
  if (options.sequence && format != ExportFormat::kKittiTracking) {
    throw UsageError("--sequence: only KITTI's tracking layout has sequences");
  }
  if ((options.without_truth || options.without_laser) && format != ExportFormat::kSkyhalo) {
    throw UsageError(std::string(options.without_truth ? "--no-truth" : "--no-laser") +
                     ": only skyhalo's own layout can leave it out");
  }
  const SimulationOptions& wish = options.simulation;
  const bool ins_errs =
      !wish.ins_noise.empty() || !wish.ins_drift.empty() || wish.ins_delay_s != 0.0;
  if (ins_errs && format == ExportFormat::kEuroc) {
    throw UsageError("--ins-...: EuRoC's layout has true poses only");
  }
}

/// How to look at what was written.
std::string advice(ExportFormat format,
                   const SimulateOptions& options,
                   const SimulatedFlight& flight) {
  if (format != ExportFormat::kKittiTracking) {
    return "skyhalo run " + options.out;
  }
  const std::string sequence = number_text("%04.0f", options.sequence.value_or(0));
  const bool sees_anything = !flight.laser_returns(0).empty();
  return std::string("skyhalo ") + (sees_anything ? "evaluate " : "run ") + options.out +
         " --sequence " + sequence;
}

std::optional<RigDescription> read_rig(const SimulateOptions& options, const Config& config) {
  if (options.rig.empty()) {
    return std::nullopt;
  }
  open_rig(options.rig, options.common, config);  // says what looks wrong in it
  return read_rig_file(options.rig).description;
}

void simulate(const SimulateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = load_config(options.common);
  const ThreadLimit limit(options.common.threads);
  const ExportFormat format = format_of(options.format);
  check_options(format, options);
  const RigDescription rig = rig_for(format, read_rig(options, config), options.pair);
  const SimulationOptions wish = wish_for(format, options.simulation);
  const auto flight = make_flight(wish, options.common, open_scene(wish), resolve(rig));
  export_flight(*flight,
                rig,
                {.format = format,
                 .folder = options.out,
                 .sequence = options.sequence.value_or(0),
                 .with_truth = !options.without_truth,
                 .with_laser = !options.without_laser,
                 .voxel_m = config.detector.map.voxel_m,
                 .downscale = config.detector.matching.downscale,
                 .source = {{"scene", wish.scene},
                            {"difficulty", number_text("%g", wish.difficulty)},
                            {"seed", std::to_string(wish.seed)},
                            {"trajectory", wish.trajectory}}},
                options.common.quiet);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const nlohmann::json summary{{"scene", wish.scene},
                               {"frames", flight->frame_count()},
                               {"rate_hz", flight->config().rate_hz},
                               {"pairs", rig.pairs.size()},
                               {"triangles", flight->scene().fixed.triangles.size()},
                               {"moving_objects", flight->scene().movers.size()},
                               {"format", options.format},
                               {"duration_s", seconds},
                               {"out", options.out}};
  std::ostringstream text;
  text << flight->frame_count() << " frames of " << rig.pairs.size()
       << (rig.pairs.size() == 1 ? " pair" : " pairs") << " in " << number_text("%.1f", seconds)
       << " s.\nLook at it with: " << advice(format, options, *flight) << "\n";
  print_result(options.common, text.str(), summary);
}

}  // namespace

void add_simulate(CLI::App& program) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = program.add_subcommand(
      "simulate",
      "a recorded flight through a generated scene or a mesh, with exact ground truth\n"
      "Images are ray traced through each camera's own lens, with rolling shutter, noise and "
      "blur.");
  add_simulation_options(*command, options->simulation);
  command
      ->add_option("--rig",
                   options->rig,
                   "rig file of the cameras (default: the reference platform's four pairs; for "
                   "kitti-tracking and euroc cameras such as theirs)")
      ->type_name("FILE");
  command
      ->add_option(
          "--pair", options->pair, "only this pair of the rig; kitti-tracking and euroc have one")
      ->type_name("NAME");
  command->add_option("--format", options->format, "layout of the recording")
      ->check(CLI::IsMember({"skyhalo", "kitti-tracking", "euroc"}))
      ->capture_default_str();
  command
      ->add_option(
          "--sequence", options->sequence, "kitti-tracking: number of the sequence (default: 0)")
      ->type_name("N")
      ->check(CLI::Range(0, 9999));
  command
      ->add_option("--laser-sigma",
                   options->simulation.laser_sigma_m,
                   "standard deviation of laser ranges (m)")
      ->type_name("M")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag(
      "--no-truth", options->without_truth, "skyhalo: leave out exact depth, disparity and cells");
  command->add_flag("--no-laser", options->without_laser, "skyhalo: leave out the laser scans");
  command->add_option("--out", options->out, "folder for the recording")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { simulate(*options); });
}

}  // namespace skyhalo::app
